"""A program's imports, read from its source, and the modules of the robot's Python. Without a robot."""

from __future__ import annotations

import ast
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest
from loops import for_each
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, Agents, LocalRobot, project_of

from pyfrc_core.deploy.agent.imports import installed_packages, is_there
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.facts import DeployRequest
from pyfrc_core.deploy.program_imports import ProgramImports, imports_in

# --- the statements of one file


@for_each(
    "source, certain, perhaps",
    [
        ("import a, b.c\nfrom d import e", ["a", "b.c", "d"], []),
        ("class A:\n    import a\nfor x in []:\n    import b\nwith open('x'):\n    import c", ["a", "b", "c"], []),
        ("def f():\n    import a\n    async def g():\n        import b", [], ["a", "b"]),
        ("def _simulationInit(self):\n    import a", [], []),
        ("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import a\nelse:\n    import b", ["typing", "b"], []),
        ("import typing as t\nif t.TYPE_CHECKING:\n    import a", ["typing"], []),
        ("if wpilib.RobotBase.isSimulation():\n    import a\nelse:\n    import b", ["b"], []),
        ("if not RobotBase.isReal() and x:\n    import a", [], []),
        ("if sys.platform == 'win32':\n    import a\nelif os.name == 'posix':\n    import b", ["b"], []),
        ("if sys.platform.startswith('linux'):\n    import a", ["a"], []),
        ("if __name__ == '__main__':\n    import a", [], []),
        ("if DEBUG:\n    import a", [], ["a"]),
        ("try:\n    import a\nexcept ImportError:\n    a = None", [], []),
        ("try:\n    import a\nexcept (ValueError, ModuleNotFoundError):\n    pass", [], []),
        ("try:\n    import a\nexcept ValueError:\n    pass", ["a"], []),
        ("try:\n    import a\nexcept ImportError:\n    raise SystemExit('no a')", ["a"], []),
        ("from contextlib import suppress\nwith suppress(ImportError):\n    import a", ["contextlib"], []),
        ("match x:\n    case 1:\n        import a", [], ["a"]),
    ],
)
def test_which_imports_the_robot_runs(source: str, certain: list[str], perhaps: list[str]) -> None:
    found = imports_in(ast.parse(source), "")
    assert [each.module for each in found if each.certain] == certain
    assert [each.module for each in found if not each.certain] == perhaps


def test_an_import_in_the_place_of_another() -> None:
    source = "try:\n    import a\nexcept ImportError:\n    import b\n"
    (found,) = imports_in(ast.parse(source), "")
    assert (found.module, found.instead, found.certain) == ("b", ("a",), True)
    source = "if sys.version_info >= (3, 11):\n    import tomllib\nelse:\n    import tomli\n"
    assert {each.module: each.instead for each in imports_in(ast.parse(source), "")} == {
        "tomllib": ("tomli",),
        "tomli": ("tomllib",),
    }


def test_relative_imports() -> None:
    source = "from . import x\nfrom .a import y\nfrom .. import z\nfrom ...b import w\n"
    assert [each.module for each in imports_in(ast.parse(source), "p.q")] == ["p.q", "p.q.a", "p", "...b"]
    assert [each.module for each in imports_in(ast.parse("from .a import y"), "")] == [".a"]


# --- the program's files


def program(directory: Path, files: dict[str, str]) -> ProgramImports:
    project = project_of(directory, files)
    return ProgramImports({each.path: each.file for each in project.entries}, "robot.py")


def outside(found: ProgramImports) -> dict[str, str]:
    return {each.wanted.module: each.where for each in found.outside}


def test_only_files_that_the_program_uses_are_read(tmp_path: Path) -> None:
    found = program(
        tmp_path,
        {
            "robot.py": "import wpilib\nimport arm\nfrom subsystems import drive\n",
            "arm.py": "import phoenix6\n\ndef later():\n    import extra\n",
            "extra.py": "import numpy\n",
            "subsystems/__init__.py": "from .base import Base\n",
            "subsystems/base.py": "import commands2\n",
            "subsystems/drive.py": "from . import base\nimport robot\n",
            "physics.py": "import pyfrc\n",
            "tests/pyfrc_test.py": "from pyfrc.tests import *\n",
            "old/robot.py": "print 'python 2'\n",
        },
    )
    assert outside(found) == {
        "wpilib": "robot.py:1",
        "phoenix6": "arm.py:1",
        "numpy": "extra.py:1",
        "commands2": "subsystems/base.py:1",
    }
    assert [each.wanted.module for each in found.outside if not each.wanted.certain] == ["numpy"]
    assert found.certain == {
        "robot.py",
        "arm.py",
        "subsystems/__init__.py",
        "subsystems/base.py",
        "subsystems/drive.py",
    }
    assert found.lost == []


def test_a_file_imported_perhaps_at_first_and_then_for_certain(tmp_path: Path) -> None:
    files = {
        "robot.py": "import b\ndef f():\n    import a\n",
        "b.py": "import a\n",
        "a.py": "import numpy\n",
    }
    found = program(tmp_path, files)
    assert [(each.wanted.module, each.wanted.certain) for each in found.outside] == [("numpy", True)]
    assert found.certain == set(files)


def test_modules_that_the_program_has_not(tmp_path: Path) -> None:
    found = program(
        tmp_path,
        {
            "robot.py": "import subsystems.drvie\nfrom things import one, two\nfrom .x import y\nimport lib.fast\n",
            "subsystems/__init__.py": "",
            "subsystems/drive.py": "",
            "things/one.py": "",  # a namespace package: it has nothing but modules
            "lib/fast.cpython-314-arm-linux-gnueabihf.so": "",
        },
    )
    assert {each.wanted.module for each in found.lost} == {"subsystems.drvie", "things.two", ".x"}


def test_what_the_laptops_python_cannot_read_asks_for_nothing(tmp_path: Path) -> None:
    found = program(tmp_path, {"robot.py": "import wpilib\nimport new\n", "new.py": "import (\n"})
    assert outside(found) == {"wpilib": "robot.py:1"}
    assert "new.py" in found.certain


# --- the robot's Python


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with packages that fail when they are imported."""
    files = {
        "package/__init__.py": "1 / 0",
        "package/inner/deep.py": "1 / 0",
        "space/part.py": "1 / 0",
        "space/more/part.py": "1 / 0",
        f"fast{EXTENSION_SUFFIXES[0]}": "",
        "other.cpython-399-sparc.so": "",
        "robotpy_thing-2026.1.dist-info/METADATA": "",
        "Old.Thing-1.5-py3.9.egg-info": "",
    }
    site = tmp_path / "site"
    project_of(site, files)
    monkeypatch.setattr(sys, "path", [*sys.path, str(site)])
    return site


@pytest.mark.parametrize(
    "name",
    [
        "sys",
        "os",
        "os.path",
        "json.decoder",
        "package",
        "package.inner",
        "package.inner.deep",
        "space.part",
        "fast",
        "space.more.part",
        "fast.made_by_it",
    ],
)
def test_modules_that_are_there(site: Path, name: str) -> None:
    assert is_there(name)


@pytest.mark.parametrize(
    "name",
    ["no_such", "no_such.a", "package.no_such", "package.inner.no_such", "space.no_such", "json.no_such", "other"],
)
def test_modules_that_are_not_there(site: Path, name: str) -> None:
    assert not is_there(name)


def test_nothing_was_imported_to_find_it(site: Path) -> None:
    assert is_there("package.inner.deep")
    assert "package" not in sys.modules


def test_installed_packages_by_their_normalized_names(site: Path) -> None:
    packages = installed_packages()
    assert packages["robotpy-thing"] == "2026.1"
    assert packages["old-thing"] == "1.5"


def test_the_current_directory_is_not_the_robots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here_only.py").write_text("")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    assert not is_there("here_only")


# --- what the robot's Python cannot compile

INVALID = "import wpilib\n\nprint 'hello'\n"


def test_it_is_refused_before_anything_changes(robot: LocalRobot, agents: Agents, tmp_path: Path) -> None:
    robot.deploy(agents, project_of(tmp_path / "old", {"robot.py": ROBOT_PY}))
    project = project_of(tmp_path / "new", {"robot.py": "import arm\n", "arm.py": INVALID})
    before = robot.startable()
    session = robot.start(agents)
    with pytest.raises(RefusedError, match=r"arm\.py:3: the robot's Python 3\.\d+ cannot compile this: ."):
        session.deploy(project, DeployRequest("robot.py", {}, program=["robot.py", "arm.py"]))
    assert session.info().current == 1
    session.close()
    assert robot.startable() == before
    assert not (robot.home / ".pyfrc/incoming").exists()


def test_a_file_that_the_program_does_not_use_may_be_anything(
    robot: LocalRobot, agents: Agents, tmp_path: Path
) -> None:
    project = project_of(tmp_path, {"robot.py": ROBOT_PY, "old/robot.py": INVALID})
    session = robot.start(agents)
    assert session.deploy(project, DeployRequest("robot.py", {}, program=["robot.py"])).release == 1
    session.close()


def test_the_robots_own_python_decides(robot: LocalRobot, agents: Agents, tmp_path: Path) -> None:
    """The first message has the modules; the response has those that the robot cannot find."""
    from pyfrc_core.deploy.agent_client import AgentClient

    robot._agents, robot._options = agents, {}
    hello = {"root": str(robot.root), "modules": ["wpilib", "no_such", "json.no_such", "json.decoder"]}
    session = AgentClient.start(robot, hello=hello)
    assert session.facts.missing_modules == ("no_such", "json.no_such")
    assert session.facts.packages["wpilib"] == session.facts.wpilib
    session.close()


@pytest.mark.parametrize(
    "source",
    [
        "import a\n\nX = 1\n",
        "from a import (\n    b,\nc,\n)\nX = (\n1)\n",
        "try:\n    import a\nexcept ValueError:\n    pass\nexcept ImportError:\n    pass\nX = 1\n",
        "'''\nimport a\nX = 1\n'''\nif X:\n    import b\nelse:\n    pass\n",
        "import a, \\\nb\n",
        "class A:\n    def f(self):\n        import a\n\n    def g(self):\n        pass\n",
        "X = 1 # import\n",
    ],
)
def test_reading_a_file_only_as_far_as_there_are_imports(source: str, tmp_path: Path) -> None:
    found = program(tmp_path, {"robot.py": source + "\nY = 1\n" * 3})
    expected = imports_in(ast.parse(source), "")
    assert [each.wanted for each in found.outside] == expected
