"""Robots that cannot be imported, and files with no robot class or with two: reported once, before any test runs."""

from __future__ import annotations

import re

import pytest
from conftest import MakeProject, sampled
from test_failures import ANY_TEST, first_line


def test_a_robot_that_cannot_be_imported_is_told_once_with_its_line(make_project: MakeProject) -> None:
    project = make_project(
        {"robot.py": "import wpilib\nimport arm\n", "arm.py": "x = 1\n\nx = y\n", "tests/test_a.py": ANY_TEST}
    )
    result = project.run("test")
    assert result.code == 1, result.output
    assert result.first_error == "arm.py:3: NameError: name 'y' is not defined"
    assert result.output.count("NameError") == 1
    assert "Traceback" not in result.output


LOOPS_WHILE_IMPORTED = """
    import wpilib

    count = 0
    while True:
        count += 1  # for ever

    class MyRobot(wpilib.TimedRobot):
        pass
"""


@pytest.mark.parametrize(
    "command",
    sampled(["test", "fuzz --runs 1", "sim --ui none"], "test"),
)
def test_an_endless_loop_in_a_file_that_is_imported_is_told_with_its_line(
    make_project: MakeProject, command: str
) -> None:
    project = make_project(
        {
            "robot.py": "import arm\n",
            "arm.py": LOOPS_WHILE_IMPORTED,
            "tests/test_a.py": ANY_TEST,
            "pyproject.toml": "[tool.pyfrc.test]\nhang_seconds = 0.2\n",
        }
    )
    result = project.run(*command.split())
    assert result.code == 1, result.output
    assert re.search(r"\barm\.py:[45]: the robot code hangs here, through 0\.2 s of computing\n", result.output)
    assert "Is it an endless loop?" in result.output
    assert "Traceback" not in result.output


def test_verbose_shows_the_traceback_of_a_robot_that_cannot_be_imported(make_project: MakeProject) -> None:
    project = make_project({"robot.py": "import wpilib\nx = y\n", "tests/test_a.py": ANY_TEST})
    result = project.run("-v", "test")
    assert result.code == 1
    assert "Traceback (most recent call last)" in result.stderr
    assert "NameError" in result.stderr


@pytest.mark.season_2026  # where tests are collected for opmodes, it is one error of each file
def test_plain_pytest_tells_a_robot_that_cannot_be_imported_in_a_line(make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": "import wpilib\n\nimport not_installed\n\n\nclass Robot(wpilib.TimedRobot):\n    pass\n",
            "tests/pyfrc_test.py": "from pyfrc.tests.basic import test_autonomous, test_disabled\n",
        }
    )
    result = project.pytest()
    assert result.code == 1
    first, *others = result.blocks().values()
    assert first_line(first).startswith("robot.py:3: there is no module not_installed")
    for block in (first, *others):
        assert first_line(block).startswith("robot.py:3: ")
        assert not re.search(r"pyfrc_core[/\\]", block)


TWO_ROBOTS = """
    import wpilib


    class Competition(wpilib.TimedRobot):
        name = "competition"


    class Practice(wpilib.TimedRobot):
        name = "practice"
"""


WHICH_ROBOT = """
    def test_which(control, robot):
        control.run_test(lambda tm: tm < 1)
        assert robot.name == "practice"
"""


@pytest.mark.slow
def test_two_robot_classes_ask_for_a_choice(make_project: MakeProject) -> None:
    project = make_project({"robot.py": TWO_ROBOTS, "tests/test_which.py": WHICH_ROBOT})
    undecided = project.run("test")
    assert undecided.code == 2, undecided.output
    for name in ("Competition", "Practice"):
        assert f"{name} ({project.place('robot.py', f'class {name}')})" in undecided.first_error
    assert "--robot-class" in undecided.stderr
    assert "robot_class = " in undecided.stderr

    chosen = project.run("test", "--robot-class", "Practice")
    assert chosen.code == 0, chosen.output

    unknown = project.run("test", "--robot-class", "Practise")
    assert unknown.code == 2, unknown.output
    assert "there is no robot class 'Practise'" in unknown.first_error
    assert "Competition, Practice" in unknown.stderr

    project.write({"pyproject.toml": '[tool.pyfrc]\nrobot_class = "Practice"\n'})
    settled = project.run("test")
    assert settled.code == 0, settled.output
