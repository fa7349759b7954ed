"""A finding does not end the season: matches go on after misbehavior, and later ones find what is behind a failure."""

from __future__ import annotations

from typing import Any

import pytest

from pyfrc_core.runtime.scripts.script import load_script

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
            {created}

        def disabledPeriodic(self):
            {disabled}

        def teleopPeriodic(self):
            {teleop}
    """


def make(make_project: Any, *, created: str = "pass", disabled: str = "pass", teleop: str = "pass", seconds: float = 6):
    code = ROBOT.format(created=created, disabled=disabled, teleop=teleop)
    return make_project({"robot.py": code, "pyproject.toml": SHORT_MATCHES.format(seconds)})


def test_after_misbehavior_the_match_goes_on(make_project) -> None:
    project = make(make_project, disabled="self.motor.set(0.2)", teleop="self.motor.set(1 / 0)", seconds=20)
    result = project.run("fuzz", "--seed", "1", "--runs", "2")
    assert result.code == 1
    assert f"{project.place('robot.py', 'set(0.2)')}: set() commands a motor to move" in result.stdout, result.output
    assert f"{project.place('robot.py', '1 / 0')}: ZeroDivisionError" in result.stdout
    assert "2 failures" in result.stdout


def test_one_misbehavior_does_not_hide_another_from_its_script(make_project) -> None:
    teleop = "self.motor.set(float('nan')) if self.gamepad.getAButton() else None"
    project = make(make_project, disabled="self.motor.set(0.2)", teleop=teleop, seconds=20)
    assert project.run("fuzz", "--seed", "1", "--runs", "8").code == 1
    file = "tests/fuzz/not_a_number-robot-teleopperiodic.jsonl"
    replayed = project.run("replay", file)
    assert f"then {project.place('robot.py', 'nan')}: set() was called with NaN" in replayed.output
    assert sum(len(step.writes) for step in load_script(project.path / file).steps) == 2


def test_motors_while_disabled_are_reported_once(make_project) -> None:
    disabled = "self.motor.set(0.2)\n            self.motor.set(0.3)"
    project = make(make_project, disabled=disabled, seconds=20)
    result = project.run("fuzz", "--seed", "1", "--runs", "2")
    assert "1 failure" in result.stdout, result.output


@pytest.mark.parametrize(
    ("created", "disabled"),
    [
        ("pass", "self.can.set(0.2)"),
        ("pass", "self.can.setVoltage(4.0)"),
        ("self.drive = DifferentialDrive(self.can, CanMotor())", "self.drive.arcadeDrive(0.5, 0.0)"),
        ("self.group = wpilib.MotorControllerGroup(self.can)", "self.group.set(0.5)"),
        ("self.drive = DifferentialDrive(self.can.set, self.can.set)", "self.drive.tankDrive(0.5, 0.5)"),
    ],
)
def test_controllers_on_the_can_bus_are_inert_while_disabled(created: str, disabled: str, make_project) -> None:
    project = make(make_project, created=created, disabled=disabled, seconds=20)
    result = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert result.code == 0, result.output


@pytest.mark.parametrize(
    ("created", "disabled"),
    [
        ("self.drive = DifferentialDrive(self.motor, self.can)", "self.drive.arcadeDrive(0.5, 0.0)"),
        ("self.group = wpilib.MotorControllerGroup(self.motor)", "self.group.set(0.5)"),
        ("self.drive = DifferentialDrive(self.motor.set, self.can.set)", "self.drive.tankDrive(0.5, 0.5)"),
    ],
)
def test_pwm_controllers_are_not(created: str, disabled: str, make_project) -> None:
    project = make(make_project, created=created, disabled=disabled, seconds=20)
    result = project.run("fuzz", "--seed", "1", "--runs", "1")
    assert "commands a motor to move while the robot is disabled" in result.stdout, result.output
