"""Robots that cannot be imported, and files with no robot class or with two: reported once, before any test runs."""

from __future__ import annotations

import re
from textwrap import dedent

import pytest
from conftest import MakeProject, sampled
from test_failures import ANY_TEST, ROBOT, first_line


@pytest.mark.parametrize(
    ("files", "file", "line", "text"),
    [
        ({"robot.py": "import wpilib\n\ndef robot(:\n    pass\n"}, "robot.py", "def robot(:", "SyntaxError: invalid"),
        (
            {"robot.py": "import wpilib\nimport arm\n", "arm.py": "x = 1\n\nwhile True\n    pass\n"},
            "arm.py",
            "while True",
            "SyntaxError: expected ':'",
        ),
        (
            {"robot.py": "import wpilib\nimport arm\n", "arm.py": "x = 1\n\nx = y\n"},
            "arm.py",
            "x = y",
            "NameError: name 'y' is not defined",
        ),
        ({"robot.py": "import wpilib\nimport amr\n"}, "robot.py", "import amr", "there is no module amr"),
    ],
    ids=["syntax", "syntax-of-another-module", "exception", "missing-module"],
)
def test_a_robot_that_cannot_be_imported_is_told_once_with_its_line(
    make_project: MakeProject, files: dict[str, str], file: str, line: str, text: str
) -> None:
    project = make_project({**files, "tests/test_a.py": ANY_TEST})
    result = project.run("test")
    assert result.code == 1, result.output
    assert result.first_error.startswith(f"{project.place(file, line)}: ")
    assert text in result.first_error
    assert result.output.count(text) == 1
    assert "Traceback" not in result.output


@pytest.mark.parametrize("has_requirements", [True, False])
def test_a_missing_module_is_told_with_how_the_projects_packages_are_installed(
    make_project: MakeProject, has_requirements: bool
) -> None:
    requirements = {"requirements.txt": "amr\n"} if has_requirements else {}
    project = make_project({"robot.py": "import amr\n", "tests/test_a.py": ANY_TEST, **requirements})
    result = project.run("test")
    assert "there is no module amr" in result.stderr
    assert ("pip install -r requirements.txt" in result.stderr) == has_requirements


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
    sampled(["test", "fuzz --runs 1", "sim --ui none", "create-physics", "replay script.jsonl"], "test"),
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
            "script.jsonl": '{"format": "pyfrc-input 1", "end": 1.0}\n',
        }
    )
    result = project.run(*command.split())
    assert result.code == 1, result.output
    assert re.search(r"\barm\.py:[45]: the robot code hangs here, through 0\.2 s of computing\n", result.output)
    assert "Is it an endless loop?" in result.output
    assert "Traceback" not in result.output


def test_what_takes_long_in_a_library_while_it_is_imported_is_no_endless_loop(make_project: MakeProject) -> None:
    busy = "import time\nbegun = time.thread_time()\nwhile time.thread_time() - begun < 0.5: pass\n"
    project = make_project(
        {
            "robot.py": f"import slow\n{dedent(ROBOT)}",
            "site-packages/slow.py": busy,
            "tests/test_a.py": ANY_TEST,
            "pyproject.toml": "[tool.pyfrc.test]\nhang_seconds = 0.2\n",
        }
    )
    result = project.run("test", env={"PYTHONPATH": str(project.path / "site-packages")})
    assert result.code == 0, result.output


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
            "tests/pyfrc_test.py": "from pyfrc.tests import *\n",
        }
    )
    result = project.pytest()
    assert result.code == 1
    first, *others = result.blocks().values()
    assert first_line(first).startswith("robot.py:3: there is no module not_installed")
    for block in (first, *others):
        assert first_line(block).startswith("robot.py:3: ")
        assert not re.search(r"pyfrc_core[/\\]", block)


def test_a_file_without_a_robot_class_says_what_one_looks_like(make_project: MakeProject) -> None:
    project = make_project({"robot.py": "import wpilib\n", "tests/test_a.py": ANY_TEST})
    result = project.run("test")
    assert result.code == 2, result.output
    assert result.first_error == "robot.py: there is no robot class in this file"
    assert "class MyRobot(wpilib.TimedRobot)" in result.stderr


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
