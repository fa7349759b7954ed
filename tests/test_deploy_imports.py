"""A program's imports, read from its source, and the modules of the robot's Python. Without a robot."""

from __future__ import annotations

import ast
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest
from loops import for_each
from roborio.fixtures import local_robot  # noqa: F401 - `robot`
from roborio.local import ROBOT_PY, LocalRobot, project_of

from pyfrc_core.deploy.agent.imports import is_there
from pyfrc_core.deploy.errors import RefusedError
from pyfrc_core.deploy.facts import DeployRequest
from pyfrc_core.deploy.program_imports import ProgramImports, imports_in

# --- the statements of one file


@for_each(
    "source, modules",
    [
        ("import a, b.c\nfrom d import e", ["a", "b.c", "d"]),
        ("class A:\n    import a\n    def f(self):\n        import b", ["a"]),
        ("def f():\n    import a", []),
        ("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import a", ["typing"]),
        ("try:\n    import a\nexcept ImportError:\n    a = None", []),
    ],
)
def test_which_imports_the_robot_always_runs(source: str, modules: list[str]) -> None:
    assert [each.module for each in imports_in(ast.parse(source).body, "")] == modules


def test_relative_imports() -> None:
    source = "from . import x\nfrom .a import y\nfrom .. import z\nfrom ...b import w\n"
    assert [each.module for each in imports_in(ast.parse(source).body, "p.q")] == ["p.q", "p.q.a", "p", "...b"]
    assert [each.module for each in imports_in(ast.parse("from .a import y").body, "")] == [".a"]


# --- the program's files


def program(directory: Path, files: dict[str, str]) -> ProgramImports:
    project = project_of(directory, files)
    return ProgramImports({each.path: each.file for each in project.entries}, "robot.py")


def outside(found: ProgramImports) -> dict[str, str]:
    return {each.module: f"{each.file}:{each.line}" for each in found.outside}


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
        "commands2": "subsystems/base.py:1",
    }
    assert found.read == {
        "robot.py",
        "arm.py",
        "subsystems/__init__.py",
        "subsystems/base.py",
        "subsystems/drive.py",
    }


def test_what_the_laptops_python_cannot_read_asks_for_nothing(tmp_path: Path) -> None:
    found = program(tmp_path, {"robot.py": "import wpilib\nimport new\n", "new.py": "import (\n"})
    assert outside(found) == {"wpilib": "robot.py:1"}
    assert "new.py" in found.read


# --- the robot's Python


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory with packages that fail when they are imported."""
    files = {
        "package/__init__.py": "1 / 0",
        "space/part.py": "1 / 0",
        f"fast{EXTENSION_SUFFIXES[0]}": "",
        "other.cpython-399-sparc.so": "",
    }
    site = tmp_path / "site"
    project_of(site, files)
    monkeypatch.setattr(sys, "path", [*sys.path, str(site)])
    return site


def test_modules_that_are_there_and_none_is_imported_to_find_it(site: Path) -> None:
    assert all(map(is_there, ("sys", "os", "json", "package", "space", "fast")))
    assert not any(map(is_there, ("no_such", "other")))
    assert "package" not in sys.modules


def test_the_current_directory_is_not_the_robots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here_only.py").write_text("")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    assert not is_there("here_only")


# --- what the robot's Python cannot compile

INVALID = "import wpilib\n\nprint 'hello'\n"


def test_it_is_refused_before_anything_changes(robot: LocalRobot, tmp_path: Path) -> None:
    robot.deploy(project_of(tmp_path / "old", {"robot.py": ROBOT_PY}))
    project = project_of(tmp_path / "new", {"robot.py": "import arm\n", "arm.py": INVALID})
    before = robot.startable()
    session = robot.start()
    with pytest.raises(RefusedError, match=r"arm\.py:3: the robot's Python 3\.\d+ cannot compile this: ."):
        session.deploy(project, DeployRequest("robot.py", {}, program=["robot.py", "arm.py"]))
    assert session.info().current == 1
    session.close()
    assert robot.startable() == before
    assert not (robot.home / ".pyfrc/incoming").exists()


def test_a_file_that_the_program_does_not_use_may_be_anything(robot: LocalRobot, tmp_path: Path) -> None:
    project = project_of(tmp_path, {"robot.py": ROBOT_PY, "old/robot.py": INVALID})
    session = robot.start()
    assert session.deploy(project, DeployRequest("robot.py", {}, program=["robot.py"])).release == 1
    session.close()


def test_the_robots_own_python_decides(robot: LocalRobot, tmp_path: Path) -> None:
    """The first message has the modules; the response has those that the robot cannot find."""
    session = robot.start(modules=["wpilib", "no_such", "json"])
    assert session.facts.missing_modules == ("no_such",)
    assert session.facts.packages["wpilib"] == session.facts.wpilib
    session.close()


@for_each(
    "source",
    [
        "import a\n\nX = 1\n",
        "from a import (\n    b,\nc,\n)\nX = (\n1)\n",
        "import b\ntry:\n    import a\nexcept ValueError:\n    pass\nexcept ImportError:\n    pass\nX = 1\n",
        "'''\nimport a\nX = 1\n'''\nimport b\n",
        "import a, \\\nb\n",
        "import b\nclass A:\n    def f(self):\n        import a\n\n    def g(self):\n        pass\n",
        "X = 1 # import\n",
    ],
)
def test_reading_a_file_only_as_far_as_there_are_imports(source: str, tmp_path: Path) -> None:
    found = program(tmp_path, {"robot.py": source + "\nY = 1\n" * 3})
    expected = imports_in(ast.parse(source).body, "")
    assert [(each.module, each.line) for each in found.outside] == [(each.module, each.line) for each in expected]
