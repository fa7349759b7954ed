"""A finding does not end the season: matches go on after misbehavior, and later ones find what is behind a failure."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from pyfrc_core.fuzz.guidance.seed_schedule import SeedScheduler
from pyfrc_core.fuzz.inputs.left_out import needed_inputs, without
from pyfrc_core.fuzz.oracle.failure import FuzzFailure
from pyfrc_core.runtime.scripts.script import InputScript, Step

SHORT_MATCHES = "[tool.pyfrc.fuzz]\nmatch_seconds = {}\n"

ROBOT = """
    import wpilib
    from wpilib.drive import DifferentialDrive
    from wpilib.interfaces import MotorController

    class CanMotor(MotorController):
        def set(self, power):
            pass

        def stopMotor(self):
            pass

        def setInverted(self, inverted):
            pass

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.gamepad = wpilib.XboxController(0)
            self.motor = wpilib.PWMSparkMax(0)
            self.can = CanMotor()
            self.late = False
            {created}

        def disabledExit(self):
            self.late = True

        def disabledPeriodic(self):
            {disabled}

        def teleopPeriodic(self):
            {teleop}
    """


#: Code of `disabledPeriodic` that is not run from the first loop on.
LATE = "{} if self.late else None"


def make(make_project: Any, *, created: str = "pass", disabled: str = "pass", teleop: str = "pass", seconds: float = 6):
    code = ROBOT.format(created=created, disabled=disabled, teleop=teleop)
    return make_project({"robot.py": code, "pyproject.toml": SHORT_MATCHES.format(seconds)})


def test_after_misbehavior_the_match_goes_on(make_project) -> None:
    created = "self.drive = DifferentialDrive(self.motor, self.can)"
    moves = "self.drive.arcadeDrive(0.5, 0.0)"
    project = make(
        make_project, created=created, disabled=LATE.format(moves), teleop="self.motor.set(1 / 0)", seconds=20
    )
    result = project.run("fuzz", "--seed", "1", "--runs", "2")
    assert result.code == 1
    assert f"{project.place('robot.py', moves)}: arcadeDrive() commands a motor to move" in result.stdout, result.output
    assert f"{project.place('robot.py', '1 / 0')}: ZeroDivisionError" in result.stdout
    assert "2 failures" in result.stdout


def test_controllers_on_the_can_bus_are_inert_while_disabled(make_project) -> None:
    created = (
        "self.drive = DifferentialDrive(self.can, CanMotor());"
        " self.group = wpilib.MotorControllerGroup(self.can);"
        " self.functions = DifferentialDrive(self.can.set, self.can.set)"
    )
    disabled = (
        "self.can.set(0.2); self.can.setVoltage(4.0); self.drive.arcadeDrive(0.5, 0.0); self.group.set(0.5);"
        " self.functions.tankDrive(0.5, 0.5)"
    )
    project = make(make_project, created=created, disabled=disabled, seconds=20)
    result = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert result.code == 0, result.output
    assert "Nothing was found." in result.stdout
    assert not (project.path / "tests").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("created", "disabled"),
    [
        ("self.group = wpilib.MotorControllerGroup(self.motor)", "self.group.set(0.5)"),
        ("self.drive = DifferentialDrive(self.motor.set, self.can.set)", "self.drive.tankDrive(0.5, 0.5)"),
    ],
)
def test_pwm_controllers_are_not(created: str, disabled: str, make_project) -> None:
    project = make(make_project, created=created, disabled=LATE.format(disabled), seconds=20)
    result = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert "commands a motor to move while the robot is disabled" in result.stdout, result.output


# -- known failures ----------------------------------------------------------------------------------------------------


def script_of(*writes: dict[str, Any]) -> InputScript:
    steps = tuple(Step(number * 20_000, each) for number, each in enumerate(writes))
    return InputScript(steps, 1_000_000, robot="robot.py", seed=0)


def test_most_matches_leave_out_an_input_of_each_known_failure() -> None:
    scheduler = SeedScheduler(1)
    often, too, seldom = (FuzzFailure("ValueError", f"robot.py:{line}", "f", "") for line in (1, 2, 3))
    for ended_by in [often, too, None] * 10 + [seldom]:
        scheduler.known.note(scheduler.schedule(0).left_out[-1][1], ended_by)
    scheduler.avoid(often, script_of({"mode": "teleop", "joysticks[0].buttons[1]": True}, {"dio[0].value": False}))
    scheduler.avoid(too, script_of({"mode": "autonomous"}, {"mode": "disabled"}, {"mode": "autonomous"}))
    scheduler.avoid(seldom, script_of({"mode": "test"}))
    chosen = Counter(frozenset(scheduler.schedule(number).left_out_at(5_000_000)) for number in range(400))
    button, switch, mode = "joysticks[0].buttons[1]", "dio[0].value", "mode=autonomous"
    assert {frozenset({button, mode}), frozenset({switch, mode}), frozenset({button}), frozenset({mode})} < set(chosen)
    assert 100 < chosen[frozenset({button, mode})] < 250
    assert sum(count for left_out, count in chosen.items() if left_out) > 380
    assert 10 < sum(count for left_out, count in chosen.items() if "mode=test" in left_out) < 80


def test_what_a_match_leaves_out_is_not_written_but_may_be_let_go() -> None:
    button, pov, switch = "joysticks[0].buttons[1]", "joysticks[0].povs[0]", "dio[0].value"
    left_out = frozenset({button, pov, switch, "joysticks[0].plugged", "mode=teleop"})
    pressed = {button: True, pov: 90, switch: True, "joysticks[0].plugged": False, "joysticks[0].axes[1]": 0.5}
    assert without(left_out, pressed) == {"joysticks[0].axes[1]": 0.5}
    assert without(left_out, {button: False, pov: -1, switch: False}) == {button: False, pov: -1}
    assert without(left_out, {"mode": "teleop", "match_time": 9.0}) == {"mode": "disabled", "match_time": 9.0}
    assert without(left_out, {"mode": "autonomous"}) == {"mode": "autonomous"}


def test_of_opmodes_only_the_one_that_fails_is_left_out() -> None:
    chosen = Step(20_000, {"mode": "teleop", "control.opmode": "Drive"})
    assert needed_inputs(InputScript((chosen,), 40_000)) == ("control.opmode=Drive",)
    left_out = frozenset({"control.opmode=Drive"})
    assert without(left_out, {"control.opmode": "Drive"}) == {"control.opmode": ""}
    assert without(left_out, {"control.opmode": "Forward"}) == {"control.opmode": "Forward"}
