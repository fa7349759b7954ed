"""Simple drivetrains: compute the robot's motion from its motors' values."""

from pyfrc_core.physics.deadzones import DeadzoneCallable, linear_deadzone
from pyfrc_core.physics.deprecated_drivetrains import four_motor_drivetrain, mecanum_drivetrain, two_motor_drivetrain
from pyfrc_core.physics.drivetrains import (
    DriveVector,
    FourMotorDrivetrain,
    MecanumDrivetrain,
    TwoMotorDrivetrain,
    four_motor_serve_drivetrain,
    four_motor_swerve_drivetrain,
)

__all__ = [
    "DeadzoneCallable",
    "DriveVector",
    "FourMotorDrivetrain",
    "MecanumDrivetrain",
    "TwoMotorDrivetrain",
    "four_motor_drivetrain",
    "four_motor_serve_drivetrain",
    "four_motor_swerve_drivetrain",
    "linear_deadzone",
    "mecanum_drivetrain",
    "two_motor_drivetrain",
]
