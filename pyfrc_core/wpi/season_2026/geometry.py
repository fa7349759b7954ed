"""Poses, speeds and kinematics, as robot code and a team's ``physics.py`` have them.

They are WPILib's own objects. What is read of them has the same name in each season: `x`, `y`, `vx`, `vy`, `omega`,
``rotation().radians()``, ``norm()`` and arithmetic; so there are functions only to make them.
"""

from __future__ import annotations

from wpimath.geometry import Pose2d as Pose2d
from wpimath.geometry import Rotation2d
from wpimath.geometry import Transform2d as Transform2d
from wpimath.geometry import Translation2d as Translation2d
from wpimath.kinematics import ChassisSpeeds as ChassisSpeeds
from wpimath.kinematics import DifferentialDriveKinematics as DifferentialDriveKinematics
from wpimath.kinematics import DifferentialDriveWheelSpeeds as DifferentialDriveWheelSpeeds
from wpimath.kinematics import MecanumDriveKinematics as MecanumDriveKinematics
from wpimath.kinematics import MecanumDriveWheelSpeeds as MecanumDriveWheelSpeeds
from wpimath.kinematics import (
    SwerveDrive4Kinematics,
)


def pose(x: float = 0.0, y: float = 0.0, angle: float = 0.0) -> Pose2d:
    """Return a pose, in metres and counter-clockwise radians."""
    return Pose2d(x, y, Rotation2d(angle))


def translation(x: float = 0.0, y: float = 0.0) -> Translation2d:
    """Return a translation, in metres."""
    return Translation2d(x, y)


def polar(length: float, angle: float) -> Translation2d:
    """Return the translation of a length in metres in a direction in radians."""
    return Translation2d(length, 0).rotateBy(Rotation2d(angle))


def transform_in_feet(x: float, y: float, angle: float) -> Transform2d:
    """Return a transform, from feet and counter-clockwise radians."""
    return Transform2d.fromFeet(x, y, angle)


def chassis_speeds(vx: float, vy: float, omega: float) -> ChassisSpeeds:
    """Return the speeds of a robot forward and to the left in m/s, and counter-clockwise in rad/s."""
    return ChassisSpeeds(vx, vy, omega)


def chassis_speeds_in_feet(vx: float, vy: float, omega: float) -> ChassisSpeeds:
    """Return the speeds of a robot, from ft/s forward and to the left, and rad/s counter-clockwise."""
    return ChassisSpeeds.fromFeet(vx, vy, omega)


def tank_kinematics(width: float) -> DifferentialDriveKinematics:
    """Return the kinematics of a tank drive.

    :param width: the distance between left and right wheels, in metres
    """
    return DifferentialDriveKinematics(width)


def tank_wheel_speeds_in_feet(left: float, right: float) -> DifferentialDriveWheelSpeeds:
    """Return the speeds of both sides, from ft/s."""
    return DifferentialDriveWheelSpeeds.fromFeet(left, right)


def mecanum_kinematics(x: float, y: float) -> MecanumDriveKinematics:
    """Return the kinematics of a mecanum drive.

    :param x: how far the wheels are in front of the centre, or behind it, in metres
    :param y: how far they are to the left or the right
    """
    return MecanumDriveKinematics(
        Translation2d(x, y), Translation2d(x, -y), Translation2d(-x, y), Translation2d(-x, -y)
    )


def mecanum_wheel_speeds_in_feet(
    left_front: float, right_front: float, left_rear: float, right_rear: float
) -> MecanumDriveWheelSpeeds:
    """Return the speeds of the wheels, from ft/s."""
    return MecanumDriveWheelSpeeds.fromFeet(left_front, right_front, left_rear, right_rear)


def track_width(thing: object) -> float | None:
    """Return the distance between left and right wheels in metres, if this is the kinematics of a tank drive."""
    return thing.trackWidth if isinstance(thing, DifferentialDriveKinematics) else None


def module_places(thing: object) -> list[Translation2d] | None:
    """Return the places of the modules in metres, if this is the kinematics of a swerve drive with four."""
    return list(thing.getModules()) if isinstance(thing, SwerveDrive4Kinematics) else None
