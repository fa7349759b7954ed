"""An opmode without `end` leaves its motors running in the next opmode: fuzz finds them, and no others."""

from __future__ import annotations

import pytest
from conftest import MakeProject

ROBOT = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.drive = wpilib.DifferentialDrive(wpilib_drivers.PWMSparkMax(0), wpilib_drivers.PWMSparkMax(1))
            self.drive.set_safety_enabled(False)
            self.arm = wpilib_drivers.PWMSparkMax(2)


    @wpilib.autonomous
    class Leave(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot

        def periodic(self):
            self.robot.drive.arcade_drive(0.5, 0, False)
            self.robot.arm.set_throttle(0.3)

        def end(self):
            {end}


    @wpilib.teleop
    class Climb(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot
            self.hook = wpilib_drivers.PWMSparkMax(5)  # a new one each time
            self.wheels = wpilib.DifferentialDrive(wpilib_drivers.PWMSparkMax(6), wpilib_drivers.PWMSparkMax(7))

        def periodic(self):
            self.hook.set_throttle(0.2)
            self.wheels.arcade_drive(0.2, 0)
"""
DRIVE, ARM = "self.robot.drive.arcade_drive(0.5, 0, False)", "self.robot.arm.set_throttle(0.3)"
SHORT = "[tool.pyfrc.fuzz]\nmatch_seconds = 12\n"


@pytest.mark.parametrize(
    ("end", "left"),
    [
        ("self.robot.arm.set_throttle(0)", [(DRIVE, "0.49")]),
        pytest.param("self.robot.drive.stop_motor()", [(ARM, "0.30")], marks=pytest.mark.slow),
        pytest.param("self.robot.drive.stop_motor(), self.robot.arm.set_throttle(0)", [], marks=pytest.mark.slow),
    ],
    ids=["the drive", "a motor", "none"],
)
def test_what_an_opmode_leaves_running_is_found(
    make_project: MakeProject, end: str, left: list[tuple[str, str]]
) -> None:
    project = make_project({"robot.py": ROBOT.format(end=end), "pyproject.toml": SHORT})
    result = project.run("fuzz", "--runs", "12", "--seed", "1", "-j", "1")
    assert (result.code, result.output.count("found robot.py")) == (int(bool(left)), len(left)), result.output
    for line, power in left:
        assert (
            f"{project.place('robot.py', line)}: the motor still runs at {power}, as the opmode Leave has set it here, "
            "1 s after the beginning of the opmode Climb: no code has set it since\n"
        ) in result.stdout
