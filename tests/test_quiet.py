"""`-q`: what was asked for, warnings and errors are printed, and nothing else, by each command."""

from __future__ import annotations

import os
import re

import pytest
from conftest import MakeProject, RobotProject, sampled
from loops import for_each
from roborio import Roborio
from roborio.fixtures import roborio  # noqa: F401 - `robot`
from test_command_line import EVERY

ROBOT = """
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            print("the robot's words")
            self.stick = wpilib.Joystick(0)

        def teleopPeriodic(self):
            if self.stick.getRawButton(1):
                raise ValueError("not that button")

        def _simulationPeriodic(self):
            pass
"""

DIES = """

    import os

    if os.path.exists("/usr/local/frc"):
        raise RuntimeError("no such gyro")
"""


@pytest.fixture(scope="module")
def project(make_shared_project: MakeProject) -> RobotProject:
    project = make_shared_project(
        {"robot.py": ROBOT, "tests/test_it.py": "def test_it(robot):\n    assert robot\n", "sim/config.json": "{}\n"}
    )
    recorded = project.run("sim", "--ui", "none", "--mode", "disabled", "--seconds", "0.1", "--record", "ran.jsonl")
    assert "simulated 0.10 s" in recorded.stdout
    assert "wrote ran.jsonl" in recorded.stdout
    return project


def words(printed: str) -> list[str]:
    """What the robot prints, without what WPILib does."""
    return [line for line in printed.splitlines() if not re.match("Not loading|Default .* Override me!$", line)]


@for_each("path", EVERY)
def test_each_command_takes_it_behind_its_name(path: tuple[str, ...]) -> None:
    options = {name for parameter in EVERY[path].params for name in parameter.opts}
    assert {"-q", "--quiet", "-v", "--verbose"} <= options


@pytest.mark.parametrize("args", [["-q", "-v", "init"], ["-q", "config", "check", "-v"], ["test", "-v", "--quiet"]])
def test_quiet_and_verbose_cannot_both_be(args: list[str], project: RobotProject) -> None:
    result = project.run_here(*args)
    assert (result.code, result.stdout) == (2, "")
    assert "--verbose and --quiet are mutually exclusive" in result.stderr


@pytest.mark.parametrize(
    "args",
    [
        ["-q", "init", "another"],
        ["add-tests", "-q"],
        ["create-physics", "--quiet"],
        ["-q", "config", "check"],
        ["config", "-q", "check", "--strict"],
    ],
    ids=" ".join,
)
def test_where_only_something_was_to_be_done_nothing_is_printed(args: list[str], make_project: MakeProject) -> None:
    robot = ROBOT.replace('            print("the robot\'s words")\n', "").replace("raise ValueError", "str")
    made = make_project({"robot.py": robot, "sim/config.json": "{}\n"})
    result = (made.run if args[0] == "create-physics" else made.run_here)(*args)
    assert (result.code, result.output) == (0, "")


@pytest.mark.parametrize("args", [["init", "--list"], ["config", "schema"]], ids=" ".join)
def test_what_was_asked_for_is_printed_all_the_same(args: list[str], project: RobotProject) -> None:
    quiet = project.run_here(*args[:-1], "-q", args[-1])
    assert quiet.code == 0, quiet.output
    assert quiet.output == project.run_here(*args).output != ""


@pytest.mark.parametrize(
    "args",
    [
        ["sim", "--ui", "none", "--mode", "disabled", "--seconds", "0.1", "--record", "again.jsonl"],
        ["replay", "ran.jsonl"],
    ],
    ids=" ".join,
)
def test_of_a_run_only_the_robots_words_are_printed(args: list[str], project: RobotProject) -> None:
    result = project.run("-q", *args)
    assert (result.code, words(result.output)) == (0, ["the robot's words"])


def test_tests_print_as_pytest_does_with_it(project: RobotProject) -> None:
    result = project.run("test", "-q")
    assert result.code == 0
    assert "test session starts" not in result.stdout
    assert "1 passed" in result.stdout
    assert "tests/test_it.py::test_it PASSED" in project.run("test", "-v").stdout


@pytest.mark.parametrize(
    "args",
    sampled([["replay", "fails.jsonl"], ["sim", "--ui", "none", "--script", "fails.jsonl"]], ["replay", "fails.jsonl"]),
)
def test_failures_are_told(args: list[str], project: RobotProject) -> None:
    head = '{"format": "pyfrc-input 1", "robot": "robot.py", "seed": 0, "end": 1}\n'
    step = '{"t": 0.1, "set": {"mode": "teleop", "joysticks[0].buttons[1]": true}}\n'
    project.write({"fails.jsonl": head + step})
    failed = project.run(*args, "--quiet")
    assert failed.code == 1
    said, failure = words(failed.stdout)
    assert said == "the robot's words"
    assert "ValueError: not that button" in failure


def test_what_is_wrong_is_told(project: RobotProject) -> None:
    wrong = project.run_here("-q", "config", "check", "--project", "none")
    assert (wrong.code, wrong.first_error) == (2, "there is no directory none")


# -- on a robot --------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_deploy_and_its_kin(robot: Roborio, make_project: MakeProject) -> None:
    failing = "def test_it():\n    print('the words of a test')\n    assert not {}\n"
    project = make_project({"robot.py": ROBOT, "tests/test_it.py": failing.format(False)})

    def quiet(*args: str) -> tuple[int, str, str]:
        result = project.run(*args, "-q", "--robot", robot.where, env={"SSH_AUTH_SOCK": ""})
        return result.code, result.stdout, result.stderr

    code, plan, errors = quiet("deploy", "--dry-run")
    assert (code, plan.splitlines()[0], errors) == (0, "+ robot.py", "")
    assert quiet("deploy") == (0, "", "")
    code, printed, errors = quiet("deploy-info")
    assert (code, printed[:10], errors) == (0, "robot     ", "")
    project.write({"tests/test_it.py": failing.format(True)})
    code, printed, errors = quiet("deploy")
    assert (code, errors.startswith("error: not deployed: the tests failed")) == (1, True)
    assert "the words of a test" in printed
    project.write({"robot.py": ROBOT + DIES})
    code, printed, errors = quiet("deploy", "--skip-tests")
    assert (code, errors.startswith("error: the new program ended after ")) == (3, True)
    assert all(line.startswith("  | ") for line in printed.splitlines())
    assert "RuntimeError: no such gyro" in printed
    assert quiet("deploy", "--rollback") == (0, "", "")
    code, printed, errors = quiet("deploy", "--rollback", "1", "--json")
    assert [line.split('"')[3] for line in printed.splitlines()] == ["result"]
    assert quiet("undeploy", "--yes") == (0, "", "")
    assert not os.path.lexists(robot.home / "py")
