"""A robot of 2026 beside WPILib 2027, in a project that does not say its season: names are explained."""

from __future__ import annotations

from pathlib import Path

import pytest

from pyfrc_core.explain import Explanation, explain
from pyfrc_core.explain.other_season import in_2027
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.season import SEASONS

INSTALL_2026 = 'pip install "wpilib>=2026.2.2,<2027"' if 2026 in SEASONS else "install the pyfrc of that season"
FOR_2026 = f"\n  If the robot is for WPILib 2026: {INSTALL_2026}"
GONE = (
    "SmartDashboard is gone: log values with telemetry.log(name, value), publish settings with "
    "tunables.add(name, value)."
)


@pytest.mark.parametrize(
    ("code", "text", "instead"),
    [
        ("import wpilib.drive", "there is no module wpilib.drive", "wpilib"),
        ("from wpimath.system.plant import DCMotor", "there is no module wpimath.system", "wpimath"),
        ("import wpiutil.log", "there is no module wpiutil.log", "wpilog"),
        ("from wpilib import PWMSparkMax", "wpilib has no PWMSparkMax", "wpilib_drivers.PWMSparkMax"),
        ("import wpilib\nwpilib.SendableChooser()", "wpilib has no SendableChooser", "tunables.Selectable"),
        (
            "import wpilib\nwpilib.getOperatingDirectory",
            "wpilib has no getOperatingDirectory",
            "wpilib.get_operating_directory",
        ),
        ("import wpilib\nwpilib.Timer.getFPGATimestamp()", "Timer has no getFPGATimestamp", "get_monotonic_timestamp"),
        (
            "import wpilib\nwpilib.DriverStation.isEnabled()",
            "DriverStation has no isEnabled",
            "wpilib.RobotState.is_enabled",
        ),
        ("import wpilib\nwpilib.DriverStation.Alliance", "DriverStation has no Alliance", "wpilib.Alliance"),
        ("import wpilib\nwpilib.RobotState.is_test()", "RobotState has no is_test", "is_utility"),
        ("import wpilib_drivers as d\nd.PWMSparkMax(0).set(1)", "PWMSparkMax has no set", "set_throttle"),
        ("import wpilib_drivers as d\nd.PWMSparkMax(1).get()", "PWMSparkMax has no get", "get_throttle"),
        ("import wpilib\nwpilib.drive.DifferentialDrive", "there is no module wpilib.drive", "wpilib"),
        ("import wpimath\nwpimath.controller.PIDController", "there is no module wpimath.controller", "wpimath"),
        ("import wpilib\nwpilib.Joystick(0).getY()", "Joystick has no getY", "get_y"),
        ("import wpimath\nwpimath.Pose2d().X()", "Pose2d has no X", "x"),
        ("import wpiutil\nwpiutil.Color.kRed", "Color has no kRed", "RED"),
        (
            "import wpilib\nclass Stick(wpilib.Joystick): pass\nStick(0).getRawButton(1)",
            "Stick has no getRawButton",
            "get_raw_button",
        ),
        (
            "import commands2\ncommands2.CommandScheduler.getInstance()",
            "CommandScheduler has no getInstance",
            "get_instance",
        ),
    ],
)
def test_a_name_of_2026(code: str, text: str, instead: str, tmp_path: Path) -> None:
    found = explained(code, tmp_path)
    assert found.text == f"{text} in WPILib 2027"
    assert found.remedy == f"Instead: {instead}.{FOR_2026}"


def test_a_name_that_is_gone_has_advice(tmp_path: Path) -> None:
    found = explained("from wpilib import SmartDashboard", tmp_path)
    assert (found.text, found.remedy) == ("wpilib has no SmartDashboard in WPILib 2027", f"{GONE}{FOR_2026}")


def test_a_remedy_is_written_in_todays_names() -> None:
    assert in_2027("Write wpimath.geometry.Rotation2d.fromDegrees(90)") == "Write wpimath.Rotation2d.from_degrees(90)"
    assert in_2027("{}.set(wpilib.DoubleSolenoid.Value.kReverse)") == "{}.set(wpilib.DoubleSolenoid.Value.REVERSE)"
    assert in_2027("Read it in autonomousInit.") == "Read it in autonomous_init."


def explained(code: str, root: Path) -> Explanation:
    try:
        exec(code, {"__name__": "robot"})
    except Exception as error:
        found = explain(error, RobotFiles(root))
        assert found is not None
        return found
    raise AssertionError("it raises nothing")


def test_names_of_the_project_itself_are_not_wpilibs(tmp_path: Path) -> None:
    found = explained("import wpilib\nclass Stick(wpilib.Joystick): left_y = 0\nStick(0).leftY", tmp_path)
    assert (found.text, found.remedy) == ("", "Did you mean left_y?")


def test_a_project_that_says_its_season_is_not_asked_for_another(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text('[tool.robotpy]\nrobotpy_version = "2027.0.0a7"\n')
    assert explained("import wpilib.drive", tmp_path).remedy == "Instead: wpilib."


def test_names_of_earlier_seasons_are_in_todays_spelling(tmp_path: Path) -> None:
    found = explained("import wpilib\nwpilib.Timer().hasPeriodPassed(1)", tmp_path)
    assert found.remedy == "Instead: has_elapsed(seconds), or advance_if_elapsed(seconds) for something that repeats."
    found = explained("import wpilib_drivers as d\nd.PWMSparkMax(2).setSpeed(1)", tmp_path)
    assert found.remedy == "Instead: set_throttle."
    assert explained("import wpilib.geometry", tmp_path).remedy.startswith("Instead: wpimath")
