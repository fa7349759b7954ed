"""Mistakes that students make first: each is explained in a sentence with its remedy, and without a traceback."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest
from conftest import MakeProject, Result, sampled
from loops import for_each
from test_failures import ANY_TEST, ROBOT

from pyfrc_core.config.toml_file import TomlFile
from pyfrc_core.errors import SettingsError

TESTS = {"tests/test_a.py": ANY_TEST}


def explained(result: Result, code: int) -> str:
    """The error of a command that ended with this exit code, in which there is no traceback."""
    assert result.code == code, result.output
    assert "Traceback" not in result.output
    assert "INTERNALERROR" not in result.output
    return result.output


# --- files that hide a library


@pytest.mark.parametrize("name", ["random.py", "wpilib/__init__.py"])
def test_a_file_that_hides_a_library_is_named_before_it_is_imported(make_project: MakeProject, name: str) -> None:
    library = name.partition("/")[0].removesuffix(".py")
    project = make_project({"robot.py": ROBOT, **TESTS, name: "1 / 0\n"})
    text = explained(project.run_here("test"), 2)
    assert f"error: {name} hides a library: import {library} finds it instead\n" in text
    assert "another name." in text


@pytest.mark.parametrize(
    "command",
    sampled(
        ["sim --ui none", "fuzz --runs 1", "replay x.jsonl", "deploy", "--pytest"],
        "sim --ui none",
        "fuzz --runs 1",
        "replay x.jsonl",
        "deploy",
    ),
)
def test_each_command_that_runs_the_robot_names_such_a_file(make_project: MakeProject, command: str) -> None:
    project = make_project({"robot.py": ROBOT, **TESTS, "commands2.py": "1 / 0\n"})
    if command == "--pytest":
        text = explained(project.run(program="pytest", cold=True), 4)
    else:
        text = explained(project.run_here(*command.split()), 2)
    assert "commands2.py hides a library: import commands2 finds it instead" in text


def test_files_with_names_of_their_own_and_rarely_used_ones_hide_nothing(make_project: MakeProject) -> None:
    files = {
        "constants.py": "X = 1\n",
        "turtle.py": "Y = 1\n",
        "tests/__init__.py": "",
        "rev/notes.txt": "no package",
        "time/notes.txt": "no package",
        "robot.py": f"import constants\nimport turtle\nprint(turtle.Y){ROBOT}".replace("\n    ", "\n"),
    }
    assert make_project(files | TESTS).run("test").code == 0


def test_a_file_with_the_name_of_a_built_in_module_is_said_never_to_be_imported(make_project: MakeProject) -> None:
    text = explained(make_project({"robot.py": ROBOT, **TESTS, "time.py": ""}).run_here("test"), 2)
    assert "time.py has the name of a library: import time finds that, never this file" in text


# --- text files in other encodings


@pytest.mark.slow
def test_a_byte_order_mark_before_the_settings_does_no_harm(make_project: MakeProject) -> None:
    settings = "\ufeff[tool.pyfrc.test]\njobs = 1\n[tool.pytest.ini_options]\naddopts = '-v'\n"
    project = make_project({"robot.py": ROBOT, "pyproject.toml": settings, **TESTS})
    result = project.run("test", "--isolation", "reuse")  # where two processes read them
    assert result.code == 0, result.output
    assert set(result.outcomes().values()) == {"PASSED"}  # so pytest has read -v in it


def test_settings_in_utf_16_are_explained(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT, **TESTS})
    (project.path / "pyproject.toml").write_bytes("[tool.pyfrc]\n".encode("utf-16"))
    text = explained(project.run_here("test"), 2)
    assert "pyproject.toml: not valid TOML: this file is in UTF-16" in text
    assert "Save it as UTF-8" in text


# --- keys of the same name in several tables


def test_a_repeated_key_is_reported_at_its_own_tables_line(make_project: MakeProject) -> None:
    settings = """
        [tool.other]
        team = 1
        text = '''
        [tool.pyfrc]
        team = 2
        '''
        [tool.pyfrc]
        list = [  # ]
            "]",
        ]
        team = 3
        [tool.third]
        team = 4
        [tool.fourth]
        team = 5
        team = 6
    """
    project = make_project({"robot.py": ROBOT, "pyproject.toml": settings})
    result = project.run_here("test")
    explained(result, 2)
    assert result.first_error.startswith("pyproject.toml:16: not valid TOML: tool.fourth.team is there twice")


def test_a_wrong_value_is_reported_at_its_own_tables_line(make_project: MakeProject) -> None:
    settings = "[tool.other]\nteam = 'a'\n[tool.pyfrc.match]\nteleop = 1\n[tool.pyfrc]\nteam = 'b'\n"
    result = make_project({"robot.py": ROBOT, "pyproject.toml": settings}).run_here("test")
    explained(result, 2)
    assert result.first_error.startswith("pyproject.toml:6: tool.pyfrc.team = 'b'")


# --- where the project is


@pytest.mark.parametrize(
    ("files", "args", "said", "remedy"),
    [
        ({"main.py": ROBOT}, "test", "but a robot class in main.py", '[tool.pyfrc]: main = "main.py"'),
        (
            {"robot.py": ROBOT, **TESTS},
            "robot.py",
            "There is no command 'robot.py'",
            "finds the robot's file by itself",
        ),
        ({"robot.py": ROBOT, **TESTS}, "test robot.py", "robot.py is the robot program", "pyfrc test"),
        (
            {"robot.py": "class A:\n    def robotInit(self): pass\n"} | TESTS,
            "test",
            "robot.py:1: the class A",
            "class A(wpi",
        ),
        (
            {"robot.py": ROBOT, "pyproject.toml": "# ours\n[pyfrc]\nteam = 1\n"},
            "test",
            "toml:2: [pyfrc] has no",
            "[tool.pyfrc]",
        ),
    ],
    ids=["main.py", "a-file-for-a-command", "the-robot-as-a-test", "no-base-class", "wrong-table"],
)
def test_the_file_and_the_class_are_named(
    make_project: MakeProject, files: dict[str, str], args: str, said: str, remedy: str
) -> None:
    text = explained(make_project(files).run_here(*args.split()), 2)
    assert said in text
    assert remedy in text


def test_one_directory_too_high_names_the_projects_below(make_project: MakeProject) -> None:
    project = make_project({"myrobot/robot.py": ROBOT, "myrobot/tests/test_a.py": ANY_TEST})
    result = project.run_here("test")
    explained(result, 2)
    assert f"there is no robot.py in or above {project.path}, but there is one in ./myrobot" in result.first_error
    assert "Go there with: cd myrobot. Or name it with: --project myrobot" in result.stderr
    named = project.run("test", "--project", "..", cwd=project.path / "myrobot")
    assert "--project ../myrobot" in named.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="making links needs a right on Windows")
def test_a_robot_file_that_is_a_link_to_nothing_is_explained(make_project: MakeProject) -> None:
    project = make_project({"tests/test_a.py": ANY_TEST})
    (project.path / "robot.py").symlink_to(Path("nowhere", "robot.py"))
    result = project.run_here("test")
    explained(result, 2)
    assert result.first_error.endswith("robot.py: a link to nowhere/robot.py, which does not exist")


# --- mistakes in the robot's code

ASKS_THE_KEYBOARD = """
    import wpilib
    {}

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            {}

        def teleopPeriodic(self):
            {}
"""

SIMULATE = "sim --ui none --mode teleop --seconds 1"

IN_TELEOP = """
    def test_it(control, robot):
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=True)
"""


@pytest.mark.parametrize("where", sampled([0, 1, 2], 1), ids=["at-import", "in-robotInit", "in-teleopPeriodic"])
def test_input_in_robot_code_is_refused_with_its_line(make_project: MakeProject, where: int) -> None:
    lines = ["pass"] * 3
    lines[where] = 'NAME = input("Speed? ")'
    project = make_project({"robot.py": ASKS_THE_KEYBOARD.format(*lines), "tests/test_a.py": IN_TELEOP})
    expected = f"{project.place('robot.py', 'input(')}: input() waits for a keyboard, and a robot has none"
    for command in ("test", *([SIMULATE] if where == 2 else [])):
        text = explained(project.run(*command.split(), stdin="5\n"), 1)
        assert expected in text
        assert "SendableChooser" in text


# --- methods that WPILib never calls

MISSPELLED = """
    import commands2
    import wpilib


    class Arm(commands2.Subsystem):
        def Periodic(self):
            pass


    class Raise(commands2.Command):
        def is_finished(self):
            return True


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.addPeriodic(self.teleop_peridic, 0.01)

        def teleopPeriodc(self):
            pass

        def autoInit(self):
            pass

        def disabled_periodic(self):
            pass

        def simulationPeriodic(self):
            pass

        # The robot's own business:

        def testPeriodic(self):
            pass

        def test_periodic(self):
            pass

        def teleop_peridic(self):
            pass

        def teleopDrive(self):
            pass

        def initRobot(self):
            pass
"""

MEANT = {
    "Periodic": "periodic",
    "is_finished": "isFinished",
    "teleopPeriodc": "teleopPeriodic",
    "autoInit": "autonomousInit",
    "disabled_periodic": "disabledPeriodic",
    "simulationPeriodic": "_simulationPeriodic",
}


@pytest.mark.parametrize(
    "command",
    [
        "test",
        pytest.param("--pytest", marks=pytest.mark.slow),
        "sim --ui none --seconds 0.1",
        *(pytest.param(each, marks=pytest.mark.slow) for each in ("doctor --no-robot", "test --late")),
    ],
)
def test_a_method_that_wpilib_never_calls_is_named_once_with_what_was_meant(
    make_project: MakeProject, command: str
) -> None:
    robot = MISSPELLED
    if command == "test --late":  # a device made by the import: the tests run from a spare process
        robot, command = f"{robot}\n    MOTOR = wpilib.PWMSparkMax(0)\n", "test"
    project = make_project({"robot.py": robot, "tests/test_a.py": IN_TELEOP})
    result = project.pytest() if command == "--pytest" else project.run(*command.split())
    assert result.code == (1 if "doctor" in command else 0), result.output
    for name, meant in MEANT.items():
        place = project.place("robot.py", f"def {name}(")
        assert re.search(rf"{place}: WPILib never calls \w+\.{name}: did you mean {meant}\?", result.output), name
    assert result.output.count("WPILib never calls") == len(MEANT)
    assert len(re.findall("names are those of WPILib 2027", result.output)) == 2


def test_a_misspelled_method_is_named_before_the_failures_that_follow_from_it(make_project: MakeProject) -> None:
    robot = "import wpilib\n\nclass MyRobot(wpilib.TimedRobot):\n    def teleopPeriodc(self):\n        pass\n"
    test = "def test_it(robot):\n    assert False\n"
    printed = make_project({"robot.py": robot, "tests/test_it.py": test}).run("test").stdout
    assert printed.index("robot.py:4: WPILib never calls") < printed.index("= FAILURES =")


# --- tests that do not test the robot that runs

NOT_THE_ROBOT = """
    import unittest
    import robot as other

    class TestIt(unittest.TestCase):
        def test_with_fixtures(self, control, robot):
            pass

    def test_disabled(control, hal_data, robot):
        control.run_test(lambda tm: tm < 0.1)
        assert hal_data["pwm"][0]["value"] == 0.25

    def test_a_number(control, robot):
        control.run_test(3)

    def test_almost(robot):
        assert 0.3512 == 0.36

    def test_made_before(control, robot):
        robot.robotInit()
        control.run_test(lambda tm: tm < 0.1)

    def test_made_in_the_run(control, robot):
        with control.run_robot():
            control.step_timing(seconds=0.1, autonomous=True, enabled=True)
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            control.step_timing(seconds=0.1, autonomous=True, enabled=True)
"""
WITH_A_MOTOR = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motor = wpilib.PWMSparkMax(0)

        def autonomousInit(self):
            self.arm = wpilib.PWMSparkMax(1)
"""


def test_tests_that_do_not_test_the_robot_that_runs(make_project: MakeProject) -> None:
    project = make_project({"robot.py": WITH_A_MOTOR, "tests/test_a.py": NOT_THE_ROBOT})
    result = project.run("test")
    blocks = result.blocks()
    expected = {
        "TestIt.test_with_fixtures": "a unittest.TestCase passes no fixtures",
        "test_disabled": "The robot was disabled in this test: write control.set_operator_control(enabled=True)",
        "test_a_number": "For three seconds of robot time, write: control.run_test(lambda tm: tm < 3)",
        "test_almost": "Write assert 0.3512 == pytest.approx(0.36, abs=0.02)",
        "test_made_before": "PWM channel 0 is used already: tests/test_a.py:19 in the test has made it before",
        "test_made_in_the_run": "This line runs more than once, and makes the device each time.",
    }
    assert {name for name, text in expected.items() if text in blocks[name]} == expected.keys(), result.stdout
    assert "unittest/case.py" not in result.stdout


@for_each(
    "line, quoted",
    [
        ("main = robot.py", 'main = "robot.py"'),
        ("robotpy_version = 2026.2.2", 'robotpy_version = "2026.2.2"'),
        ("components = [rev, navx]", 'components = ["rev", "navx"]'),
        ("jobs = 3 4", ""),
    ],
)
def test_a_text_without_quotes_in_toml(tmp_path: Path, line: str, quoted: str) -> None:
    (tmp_path / "pyproject.toml").write_text(f"[tool.pyfrc]\n{line}\n")
    with pytest.raises(SettingsError, match="not valid TOML") as caught:
        TomlFile(tmp_path / "pyproject.toml")
    assert caught.value.remedy == (f"A text needs quotes: write {quoted}" if quoted else None)
    assert str(caught.value).startswith("pyproject.toml:2: ") or "pyproject.toml:2: " in str(caught.value)
