"""`pyfrc.invariant`: rules of a team, checked by `pyfrc fuzz`, `pyfrc test` and `pyfrc replay`."""

from __future__ import annotations

import re
from typing import Any

import pytest
from core.test_invariants import rule

from pyfrc_core.runtime.scripts.script import load_script

RULES = "tests/rules.py"

#: With the left bumper held, button B drives the elevator below 0: the bug.
ELEVATOR = """
    import wpilib

    class Elevator:
        def __init__(self):
            self.motor = wpilib.PWMSparkMax(0)
            self.height = 0.5

        def move(self, power):
            self.motor.set(power)
            self.height += 0.02 * power

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.gamepad = wpilib.XboxController(0)
            self.elevator = Elevator()
            self.arm_is_in = True

        def autonomousPeriodic(self):
            self.elevator.move(0.1)

        def teleopPeriodic(self):
            self.arm_is_in = not self.gamepad.getAButton()
            power = -0.5 if self.gamepad.getBButton() else 0.5 * self.gamepad.getRightTriggerAxis()
            if self.elevator.height > 0.01 or power > 0 or self.gamepad.getLeftBumper():
                self.elevator.move(power)
            else:
                self.elevator.move(0)
    """

RULE = """
    import pyfrc

    @pyfrc.invariant
    def elevator_is_up_while_the_arm_is_in(robot):
        assert robot.elevator.height > -0.005 or not robot.arm_is_in
    """

SETTINGS = """
    [tool.pyfrc.fuzz]
    match_seconds = 10
    [tool.pyfrc.match]
    autonomous = 2
    teleop = 3
    """

READY_MADE = "from pyfrc.tests import test_autonomous, test_operator_control, test_practice\n"


@pytest.fixture
def project(make_project: Any) -> Any:
    """A robot with a bug that no exception shows."""
    return make_project({"robot.py": ELEVATOR, "pyproject.toml": SETTINGS})


@pytest.mark.slow
def test_a_broken_rule_is_found_shrunk_explained_and_replayed(project) -> None:
    project.write({RULES: RULE})
    result = project.run("fuzz", "--seed", "1", "--runs", "16")
    assert result.code == 1, result.output
    file = "tests/fuzz/invariant-tests-rules-elevator_is_up_while_the_arm_is_in.jsonl"
    script = load_script(project.path / file)
    (step,) = script.steps
    assert step.writes == {"mode": "teleop", "joysticks[0].buttons[2]": True, "joysticks[0].buttons[5]": True}
    first, last = script.story
    moment, *pressed = re.split(": |, ", first)
    assert moment == "at 0.00 s teleoperated begins"
    assert sorted(pressed) == ["joystick 0 button 2 pressed", "joystick 0 button 5 pressed"]
    place = project.place(RULES, "assert")
    broken = f"{place}: the rule elevator_is_up_while_the_arm_is_in() is broken: robot.elevator.height is -0.01, "
    moment, _, what = last.partition(": ")
    assert what == f"{broken}robot.arm_is_in is True"
    assert f"{what}\n  {moment} of robot time, in teleop mode\n" in result.stdout
    for command in ("replay", file), ("test",):
        again = project.run(*command)
        assert again.code == 1
        assert broken in again.output

    robot = project.path / "robot.py"
    robot.write_text(robot.read_text().replace(" or self.gamepad.getLeftBumper()", ""))
    for command in ("replay", file), ("test",):
        repaired = project.run(*command)
        assert repaired.code == 0, repaired.output


def test_ready_made_and_own_tests_check_the_rules(project) -> None:
    project.write(
        {
            RULES: rule("return robot.elevator.height < 0.511", "def it_is_low(robot):"),
            "tests/test_robot.py": READY_MADE
            + "\n".join(
                [
                    "def test_steps(control, robot):",
                    "    with control.run_robot():",
                    "        control.step_timing(seconds=1, autonomous=True, enabled=True)",
                    "def test_without_rules(control, robot):",
                    "    control.check_invariants = False",
                    "    with control.run_robot():",
                    "        control.step_timing(seconds=1, autonomous=True, enabled=True)",
                ]
            ),
        }
    )
    result = project.run("test", "--", "-v")
    outcomes = {test.partition("::")[2]: outcome for test, outcome in result.outcomes().items()}
    assert outcomes == {
        "test_practice": "FAILED",
        "test_autonomous[]": "FAILED",
        "test_operator_control": "PASSED",
        "test_steps": "FAILED",
        "test_without_rules": "PASSED",
    }
    text = f"{RULES}:4: the rule it_is_low() is broken: robot.elevator.height is 0.512"
    assert f"{text}\n  at 0.12 s of robot time, in autonomous mode" in result.output


def test_a_file_that_is_wrong_is_named_by_each_command(project) -> None:
    """`core/test_invariants` has each mistake."""
    message = (
        "tests/rules.py:4: the rule it_holds() has the parameter 'robots'\n"
        "  A rule can have the parameters hal_data and robot: did you mean 'robot'?"
    )
    script = '{"format": "pyfrc-input 1", "robot": "robot.py", "seed": 0, "end": 1}\n'
    files = {RULES: rule("pass", "def it_holds(robots):"), "tests/test_it.py": READY_MADE, "script.jsonl": script}
    project.write(files)
    for command in ("fuzz", "--runs", "1"), ("replay", "script.jsonl"), ("test",):
        result = project.run(*command)
        assert result.code != 0
        assert result.output.count(message) == 1, result.output


def test_a_file_whose_only_decorator_is_misspelled_is_named(project) -> None:
    project.write({RULES: rule("pass").replace("invariant", "invarient"), "tests/test_it.py": READY_MADE})
    result = project.run("test")
    assert result.code != 0
    assert f"{RULES}:3: AttributeError: module 'pyfrc' has no attribute 'invarient'" in result.output, result.output


@pytest.mark.slow
def test_a_rule_that_hangs_is_named(project) -> None:
    settings = SETTINGS.replace("match_seconds = 10", "match_seconds = 2\n    hang_seconds = 0.1")
    project.write({RULES: rule("while True: pass"), "pyproject.toml": settings})
    result = project.run("fuzz", "--runs", "1")
    assert f"{RULES}:3: it_holds() hangs" in result.output, result.output


def test_rules_in_test_files_and_values_that_are_shown(project) -> None:
    """pytest rewrites the asserts of test files: the explanation is the same."""
    file = "tests/test_rules.py"
    test = """
        import pyfrc

        LIMIT = 0.505

        def below(height):
            assert height < LIMIT, "too high"

        @pyfrc.invariant
        def first(hal_data, robot):
            below(abs(robot.elevator.height))

        @pyfrc.invariant
        def second(hal_data):
            assert hal_data["pwm"][0]["value"] == 0 or hal_data["time"]["remaining"] is None

        def test_it(control, robot):
            control.set_autonomous()
            control.run_test(lambda tm: tm < 1)
        """
    project.write({file: test})
    first, second = project.place(file, "too high"), project.place(file, "remaining")
    broken = [
        f"{first}: the rule first() is broken: too high (height is 0.506, LIMIT is 0.505)",
        f"{second}: the rule second() is broken: hal_data['pwm'][0]['value'] is 0.0996016, hal_data['time']['rem",
    ]
    result = project.run("test")
    assert any(text in result.output for text in broken), result.output


@pytest.mark.slow
def test_a_new_rule_concerns_tests_that_have_passed(project) -> None:
    project.write({"tests/test_it.py": READY_MADE})
    assert project.run("test", "--changed").code == 0
    assert "passed before" in project.run("test", "--changed").output
    for file in (RULES, "tests/test_more.py"):
        project.write({file: rule("assert robot.elevator.height < 0.51")})
        assert project.run("test", "--changed").code == 1
        (project.path / file).unlink()
