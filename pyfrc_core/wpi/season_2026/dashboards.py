"""What dashboards show: fields, with the robot on them."""

from __future__ import annotations

from collections.abc import Sequence

import wpilib
from wpilib import Field2d
from wpimath.geometry import Pose2d

__all__ = ["Field2d", "place_robot", "robot_pose", "show_field", "show_poses", "shown"]


def robot_pose(field: Field2d) -> Pose2d:
    """Return where the robot is on a field. A dashboard may have moved it."""
    return field.getRobotPose()


def place_robot(field: Field2d, pose: Pose2d) -> None:
    """Place the robot on a field."""
    field.setRobotPose(pose)


def show_poses(field: Field2d, name: str, poses: Sequence[Pose2d]) -> None:
    """Show these poses on a field, instead of others of that name."""
    field.getObject(name).setPoses(list(poses))


def show_field(name: str, field: Field2d) -> None:
    """Show a field on dashboards."""
    wpilib.SmartDashboard.putData(name, field)


def shown(name: str) -> object | None:
    """Return the object that dashboards show under a name; None if there is none."""
    try:
        return wpilib.SmartDashboard.getData(name)
    except RuntimeError:  # nothing has this name
        return None
