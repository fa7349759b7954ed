"""Plain `pytest` in an environment with pyfrc: when the plugin is active, and when it stays away."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from conftest import MakeProject, Result, sampled
from skips import require

ROBOT = """
    import wpilib


    class Robot(wpilib.TimedRobot):
        def robotInit(self):
            self.motor = wpilib.Spark(0)
"""

#: What an application that is no robot expects of its tests.
APPLICATION = """
    import sys
    import time

    COUNT = []


    def test_sleep_is_real():
        begin = time.perf_counter()
        time.sleep(0.2)
        assert time.perf_counter() - begin >= 0.2


    def test_module_state_one():
        COUNT.append(1)


    def test_module_state_two():
        assert COUNT == [1]
        assert "robot" not in sys.modules
"""

#: A robot's own test.
DRIVES = """
    def test_drives(control, robot):
        control.run_test(lambda tm: tm < 1)
        assert robot.motor.get() == 0
"""


def passed_as_without_pyfrc(result: Result) -> bool:
    return result.code == 0 and "3 passed" in result.stdout and "pyfrc:" not in result.stdout


@pytest.mark.parametrize(
    "not_a_robot",
    [
        "# Not for wpilib, magicbot or commands2\nraise SystemExit\n",
        pytest.param('"""class Robot of wpilib"""\n', marks=pytest.mark.slow),
        pytest.param("class RobotArm(Exception):\n    pass\n", marks=pytest.mark.slow),
        pytest.param("import wpilib_helper\n\n\nclass RobotArm(Exception):\n    pass\n", marks=pytest.mark.slow),
        "import os  # not wpilib\n\n\nclass Robot(os.PathLike):\n    pass\n",
    ],
)
def test_a_robot_file_without_a_robot_class_is_left_alone(make_project: MakeProject, not_a_robot: str) -> None:
    project = make_project({"robot.py": not_a_robot, "app/test_app.py": APPLICATION})
    assert passed_as_without_pyfrc(project.pytest(cwd=project.path / "app"))


@pytest.mark.parametrize(
    "robot",
    [
        "from wpilib import TimedRobot\n\n\nclass Arm(\n    TimedRobot\n):\n    pass\n",
        *sampled(
            [
                "import wpilib\n\n\nclass Robot(wpilib.TimedRobot):\n    pass\n",
                "import math, wpilib\nfrom base import Base\n\n\nclass MyRobot(Base):\n    pass\n",
                "import wpilib\nfrom base import Base\n\nif __name__ == '__main__':\n    wpilib.run(Base)\n",
            ]
        ),
    ],
)
def test_a_robot_class_makes_a_robot_project(make_project: MakeProject, robot: str) -> None:
    base = "import wpilib\n\n\nclass Base(wpilib.TimedRobot):\n    pass\n"
    test = "def test_fixtures(robot_file):\n    assert robot_file\n"
    project = make_project({"robot.py": robot, "base.py": base, "pyproject.toml": "", "tests/test_a.py": test})
    result = project.pytest(cwd=project.path / "tests")
    assert result.code == 0, result.output


@pytest.mark.parametrize("name", sampled(["robot.py", "physics.py"], "physics.py"))
def test_a_robot_of_another_user_is_not_run(make_project: MakeProject, name: str) -> None:
    require("that another user's robot is not run", [] if hasattr(os, "getuid") and os.getuid() == 0 else ["root"])
    files = {"robot.py": ROBOT, "physics.py": "class PhysicsEngine:\n    pass\n", "mine/test_app.py": APPLICATION}
    project = make_project(files)
    os.chown(project.path / name, 12345, 12345)
    result = project.pytest(cwd=project.path / "mine")
    assert result.code == 0, result.output
    assert "3 passed" in result.stdout
    (line,) = [line for line in result.stdout.splitlines() if "pyfrc:" in line]
    assert line == (
        f"pyfrc: not active: {project.path / name} belongs to another user. If you trust it, run: pyfrc test"
    )


def other_season(directory: Path) -> dict[str, str]:
    """Make a `wpilib` of an unknown season with a test tool of its own, and return the environment that has it."""
    info = directory / "wpilib-2028.0.0a1.dist-info"
    for file, text in {
        info / "METADATA": "Metadata-Version: 2.1\nName: wpilib\nVersion: 2028.0.0a1\n",
        directory / "wpilib/__init__.py": "class TimedRobot:\n    pass\n",
        directory / "hal/__init__.py": "",
        directory / "their_tool.py": "import pytest\n\n\n@pytest.fixture\ndef control():\n    return 'theirs'\n\n\n"
        "@pytest.fixture\ndef robot():\n    return 'theirs'\n",
    }.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return {"PYTHONPATH": str(directory)}


@pytest.mark.parametrize("args", sampled([["-p", "their_tool"], ["-p", "their_tool", "-q"]], ["-p", "their_tool"]))
def test_beside_an_unknown_season_it_is_as_if_not_installed(
    make_project: MakeProject, tmp_path: Path, args: list[str]
) -> None:
    test = "def test_theirs(control, robot):\n    assert control == robot == 'theirs'\n"
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": test})
    result = project.run(*args, env=other_season(tmp_path / "site"), program="pytest", cold=True)
    assert result.code == 0, result.output
    lines = [line for line in result.output.splitlines() if "pyfrc:" in line]
    wanted = ["pyfrc: not active: wpilib 2028.0.0a1 is installed here, and this pyfrc runs robots of 2026 and 2027"]
    assert lines == ([] if "-q" in args else wanted)


@pytest.mark.slow
def test_packages_that_do_not_fit_do_not_end_pytest(make_project: MakeProject, tmp_path: Path) -> None:
    project = make_project({"robot.py": ROBOT, "tests/test_a.py": "def test_plain():\n    pass\n"})
    (tmp_path / "site/hal").mkdir(parents=True)
    (tmp_path / "site/hal/__init__.py").touch()
    env = {"PYTHONPATH": str(tmp_path / "site")}
    result = project.run(env=env, program="pytest", cold=True)
    assert result.code == 0, result.output
    assert "1 passed" in result.stdout
    assert "pyfrc: not active: " in result.stdout


def test_a_robot_project_of_its_own_has_the_fixtures(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": "", "tests/test_drives.py": DRIVES})
    result = project.pytest(cwd=project.path / "tests")
    assert result.code == 0, result.output
