"""Modules and packages that the robot's Python lacks: reported before anything is changed on the robot."""

from __future__ import annotations

import dataclasses
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path

import pytest
from loops import for_each
from packaging.requirements import Requirement
from roborio import Roborio, require_roborio
from roborio.local import project_of
from test_deploy_fresh_robot import READY

from pyfrc_core.config.robotpy import RobotPackages, load_robot_packages
from pyfrc_core.deploy.robot_checks import VIRTUAL_IMAGE, obstacles
from pyfrc_core.deploy.robot_packages import ImportSearch, PackageProblem, unfit_packages
from pyfrc_core.deploy.targets import CONTROLLERS
from pyfrc_core.errors import SettingsError

GUIDE = (Path(__file__).parents[1] / "docs/reference/deploy.md").read_text("utf-8")
KEYS = ("robotpy_version", "components", "requires")
NOTHING = RobotPackages(None, (), (), {})
OURS = version("wpilib")


Problems = Callable[..., list[PackageProblem]]


@pytest.fixture
def problems(tmp_path: Path) -> Problems:
    """What is wrong with a program of these files, on a robot without these modules."""

    def find(
        files: dict[str, str], missing: tuple[str, ...], packages: RobotPackages = NOTHING
    ) -> list[PackageProblem]:
        shutil.rmtree(tmp_path / "project", ignore_errors=True)
        search = ImportSearch(project_of(tmp_path / "project", files), tmp_path / "project", "robot.py")
        absent = tuple(each for each in search.modules() if each in missing)
        return search.problems(dataclasses.replace(READY, missing_modules=absent), packages)

    return find


# --- modules


@for_each(
    "files, missing, said, remedy",
    [
        (
            {"robot.py": "import wpilib\nimport commands2.button\n"},
            ("commands2",),
            "robot.py:2: import commands2: the robot has no package robotpy-commands-v2",
            'Add "commands2" to components under [tool.robotpy] in pyproject.toml; with internet: ',
        ),
        (
            {"robot.py": "import arm\n", "arm.py": "from magicbot import tunable\n"},
            ("magicbot",),
            "arm.py:1: import magicbot: the robot has no package robotpy-wpilib-utilities",
            'Add "robotpy-wpilib-utilities" to requires under [tool.robotpy]',
        ),
        (
            {"robot.py": "import wpilib.simulation\n"},
            ("wpilib",),
            f"robot.py:1: import wpilib: wpilib {OURS} on the robot has no such module",
            "Install this computer's version",
        ),
        (
            {"robot.py": "import some_library\n"},
            ("some_library",),
            "robot.py:1: import some_library: neither the project nor the robot has such a module",
            "add it to requires under [tool.robotpy]",
        ),
        (
            {"robot.py": "import telnetlib\n" if "telnetlib" in sys.stdlib_module_names else "import curses\n"},
            ("telnetlib", "curses"),
            "Python 3.14.0 on the robot has no such module",
            "use another module",
        ),
        (
            {"robot.py": "import wpilib\n"},
            ("robotpy",),
            "robot.py: the robot has no package robotpy-cli, which starts programs",
            "pyfrc sync",
        ),
    ],
)
def test_what_is_missing(
    problems: Problems, files: dict[str, str], missing: tuple[str, ...], said: str, remedy: str
) -> None:
    (found,) = problems(files, missing)
    assert said in str(found)
    assert remedy in found.remedy


@for_each(
    "files, missing",
    [
        ({"robot.py": "try:\n    import numpy\nexcept ImportError:\n    numpy = None\n"}, ("numpy",)),
        ({"robot.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import numpy\n"}, ("numpy",)),
        ({"robot.py": "import wpilib\n", "physics.py": "import pyfrc\n"}, ("pyfrc",)),
        ({"robot.py": "import sys\nsys.path.append('lib')\nimport tool\n", "lib/tool.py": ""}, ("tool",)),
        ({"robot.py": "import space.part\n", "space/part.py": ""}, ("space",)),
        ({"robot.py": "from space import part\n", "space/other.py": ""}, ()),  # the robot has a package `space`
        ({"robot.py": "import fast\n", "fast.abi3.so": ""}, ("fast",)),
    ],
)  # fmt: skip
def test_what_is_not_missing(problems: Problems, files: dict[str, str], missing: tuple[str, ...]) -> None:
    assert problems(files, missing) == []


def test_the_imports_of_one_package_are_one_problem(problems: Problems) -> None:
    files = {
        "robot.py": "import arm, drive\n\nimport rev, typo_a\n\nimport typo_b\n",
        "arm.py": "from phoenix6.hardware import TalonFX\nimport phoenix6.configs\nimport phoenix6.controls\n",
        "drive.py": "import phoenix6\n",
    }
    found = problems(files, ("phoenix6", "rev", "typo_a", "typo_b"))
    assert [str(each).rpartition(": ")[0] for each in found if "typo" not in str(each)] == [
        "arm.py:1: import phoenix6, and 3 more imports",
        "robot.py:3: import rev",
    ]
    assert [str(each).partition(": neither")[0] for each in found if "typo" in str(each)] == [
        "robot.py:3: import typo_a",
        "robot.py:5: import typo_b",
    ]


@for_each(
    "module, remedy",
    [
        ("numpy", "Install it in the environment in which pyfrc virtual-robot runs: python -m pip install numpy."),
        (
            "commands2",
            "Install it in the environment in which pyfrc virtual-robot runs: "
            "python -m pip install robotpy-commands-v2.",
        ),
        (
            "some_library",
            "Check the name. If it is a package: in the environment in which pyfrc virtual-robot runs: "
            "python -m pip install PACKAGE.",
        ),
    ],
)
def test_a_virtual_robot_gets_packages_from_pip(tmp_path: Path, module: str, remedy: str) -> None:
    search = ImportSearch(project_of(tmp_path, {"robot.py": f"import {module}\n"}), tmp_path, "robot.py")
    virtual = dataclasses.replace(READY, image=VIRTUAL_IMAGE, missing_modules=(module,))
    (found,) = search.problems(virtual, NOTHING)
    assert found.remedy == remedy


def test_a_virtual_robot_gets_what_the_project_asks_for_from_pip() -> None:
    packages = RobotPackages("2026.9.9", ("cscore",), (Requirement("numpy>=1"),), dict.fromkeys(KEYS, "pyproject.toml"))
    virtual = dataclasses.replace(READY, image=VIRTUAL_IMAGE, wpilib=OURS, packages={})
    remedies = [each.remedy for each in unfit_packages(packages, virtual)]
    installed = [each.partition("python -m pip install ")[2] for each in remedies]
    assert installed == ["wpilib==2026.9.9.", "robotpy-cscore.", '"numpy>=1".']


@for_each("there", [{"wpilib": None}, {"wpilib": "2020.1.1", "python": "3.8.0"}])
def test_a_virtual_robot_gets_another_wpilib_only_from_its_start(there: dict[str, str | None]) -> None:
    """To deploy installs nothing on it."""
    virtual = dataclasses.replace(READY, image=VIRTUAL_IMAGE, **there)
    remedies = [each.remedy for each in obstacles(virtual, CONTROLLERS[0])]
    start = f"Start the virtual robot with wpilib {OURS}, as here: pyfrc virtual-robot."
    assert remedies == [start] * len(there)


@for_each("module", ["commands2", "cscore", "robotpy_apriltag"])
def test_a_component_s_package_is_known_where_it_is_not_installed(
    problems: Problems, module: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pyfrc_core.deploy.robot_packages.packages_by_module", dict)
    (found,) = problems({"robot.py": f"import {module}\n"}, (module,))
    assert "the robot has no package robotpy-" in found.text
    assert "to components under [tool.robotpy]" in found.remedy


def test_a_package_that_the_project_asks_for_has_only_to_be_installed(problems: Problems) -> None:
    packages = RobotPackages(None, ("all",), (), {})
    (found,) = problems({"robot.py": "import commands2\n"}, ("commands2",), packages)
    assert found.remedy.startswith("Install it: with internet: pyfrc sync; then at the robot:")


def test_a_file_that_is_left_out_of_the_upload(tmp_path: Path) -> None:
    manifest = project_of(tmp_path, {"robot.py": "import arm\n"})
    (tmp_path / "arm.py").write_text("")
    search = ImportSearch(manifest, tmp_path, "robot.py")
    assert search.modules() == ["arm", "robotpy"]
    (found,) = search.problems(dataclasses.replace(READY, missing_modules=("arm",)), NOTHING)
    assert str(found) == "robot.py:1: import arm: the project has it, but it is not uploaded"


# --- [tool.robotpy]


@for_each(
    "table, installed, said",
    [
        ("robotpy_version = '2020.1.1'", {}, f":2: robotpy_version is 2020.1.1, but the robot has wpilib {OURS}"),
        (f"robotpy_version = '{OURS}.0'", {}, None),
        ("components = ['commands2']", {}, ":2: components has commands2, but the robot has no package robotpy-comm"),
        ("components = ['commands2']", {"robotpy-commands-v2": "2026.1.1"}, ":2: the robot has robotpy-comm"),
        ("components = ['commands2', 'sim']", {"robotpy-commands-v2": OURS}, None),
        ("requires = ['Phoenix6>=26.1']", {}, ":2: requires has 'Phoenix6>=26.1', but the robot has no"),
        ("\nrequires = ['phoenix6>=26.1']", {"phoenix6": "25.3"}, ":3: requires has 'phoenix6>=26.1', but the "),
        ("requires = ['phoenix6>=26.1', 'robotpy_rev']", {"phoenix6": "26.1.1", "robotpy-rev": "2026.0"}, None),
        ("requires = ['reefscape>=2027.0.0a1']", {"reefscape": "2027.0.0a7"}, None),
        ("requires = ['colorama; sys_platform == \"win32\"']", {}, None),
        ("requires = ['numpy; platform_machine != \"roborio\"']", {}, None),
        ("requires = ['numpy; python_version >= \"3.14\"']", {}, ":2: requires has "),
    ],
)  # fmt: skip
def test_packages_that_do_not_fit(tmp_path: Path, table: str, installed: dict[str, str], said: str | None) -> None:
    pyproject = tmp_path / "pyproject.toml"
    pyproject.write_text(f"[tool.robotpy]\n{table}\n")
    robot = dataclasses.replace(READY, packages={**READY.packages, **installed})
    found = list(unfit_packages(load_robot_packages(pyproject), robot))
    assert len(found) == (said is not None)
    assert (said or "") in "".join(map(str, found))


def test_a_requirement_that_cannot_be_read_is_named_with_its_line(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text("[tool.robotpy]\n\nrequires = ['phoenix6 >> 1']\n")
    with pytest.raises(SettingsError, match="requires = 'phoenix6 >> 1'") as caught:
        load_robot_packages(tmp_path / "pyproject.toml")
    assert caught.value.where == "pyproject.toml:3"


def test_a_list_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text("[tool.robotpy]\nrequires = 'numpy'\n")
    with pytest.raises(
        SettingsError, match=r"pyproject.toml:2: requires must be a list\n  Write: requires = ..numpy.."
    ):
        load_robot_packages(tmp_path / "pyproject.toml")


def test_no_table_asks_for_nothing(tmp_path: Path) -> None:
    assert load_robot_packages(tmp_path / "pyproject.toml") == NOTHING
    (tmp_path / "pyproject.toml").write_text("[tool.ruff]\n")
    assert load_robot_packages(tmp_path / "pyproject.toml") == NOTHING


# --- on a look-alike


@pytest.fixture
def roborio() -> Iterator[Roborio]:
    require_roborio()
    with Roborio(wpilib=OURS) as look_alike:
        yield look_alike


ROBOT = "import wpilib\n{imports}\n\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"


def deploy(project, robot: Roborio, *args: str):
    return project.run("deploy", "--skip-tests", "--robot", robot.where, *args, env={"SSH_AUTH_SOCK": ""})


def test_a_missing_package_is_named_while_the_old_program_runs_on(roborio: Roborio, make_project) -> None:
    project = make_project({"robot.py": ROBOT.format(imports="")})
    assert deploy(project, roborio).code == 0
    before = roborio.said("Robot program startup complete").count("startup complete")
    project.write({"robot.py": ROBOT.format(imports="import commands2")})
    refused = deploy(project, roborio)
    assert refused.code == 1
    assert "not deployed: robot.py:2: import commands2: the robot has no package robotpy-commands-v2" in refused.output
    (shown,) = re.findall(r"^ +```text\n +(error: not deployed.*?)```$", GUIDE, re.MULTILINE | re.DOTALL)
    assert " ".join(shown.split()) in " ".join(refused.output.replace(f" --robot {roborio.where}", "").split())
    assert "Traceback" not in refused.output
    assert {each.name for each in (roborio.home / ".pyfrc").iterdir()} - {"agent"} == {"lock", "releases"}
    assert (roborio.home / "py/robot.py").read_text() == ROBOT.format(imports="")
    assert roborio.said("startup complete").count("startup complete") == before, "it was not restarted"
