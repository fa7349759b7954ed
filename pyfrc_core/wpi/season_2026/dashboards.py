"""What dashboards show: fields with the robot on them, and what their user can change."""

from __future__ import annotations

import math
from collections.abc import Sequence

import wpilib
from wpilib import Field2d
from wpimath.geometry import Pose2d
from wpiutil import Sendable, SendableBuilder, SendableRegistry

from ..widgets import DashboardControl
from . import network

__all__ = ["Field2d", "place_robot", "robot_pose", "show_field", "show_poses", "shown", "widget_of"]


def robot_pose(field: Field2d) -> Pose2d:
    """Return where the robot is on a field. A dashboard may have moved it."""
    return field.getRobotPose()


def place_robot(field: Field2d, pose: Pose2d) -> None:
    """Place the robot on a field."""
    field.setRobotPose(pose)


def placed(name: str) -> Pose2d | None:
    """Return where dashboards or scripts have placed the robot on the field of this name; None if they have not."""
    numbers = network.value_of(f"/SmartDashboard/{name}/Robot")
    if not isinstance(numbers, list) or len(numbers) != 3:
        return None
    return Pose2d(numbers[0], numbers[1], math.radians(numbers[2]))


def show_poses(field: Field2d, name: str, poses: Sequence[Pose2d]) -> None:
    """Show these poses on a field, instead of others of that name."""
    field.getObject(name).setPoses(list(poses))


def show_field(name: str, field: Field2d) -> None:
    """Show a field on dashboards."""
    wpilib.SmartDashboard.putData(name, field)


def shown(name: str) -> object | None:
    """Return the object that dashboards show under a name; None if there is none."""
    try:
        found = wpilib.SmartDashboard.getData(name)
    except RuntimeError:  # nothing has this name
        return None
    return None if isinstance(found, _Nothing) else found


class _Nothing(Sendable):
    """What a dashboard shows instead of an object that is gone."""

    def initSendable(self, builder: SendableBuilder) -> None:
        """Show nothing."""


def forget_shown() -> None:
    """Release the objects that dashboards show: `SmartDashboard` keeps them for as long as the process lives."""
    for entry in network.entry_names():
        if entry.startswith(_SMART_DASHBOARD) and entry.endswith(_TYPE):
            name = entry.removeprefix(_SMART_DASHBOARD).removesuffix(_TYPE)
            if shown(name) is not None:
                nothing = _Nothing()
                wpilib.SmartDashboard.putData(name, nothing)
                # To a table that there is not: its entries end.
                SendableRegistry.publish(SendableRegistry.getUniqueId(nothing), wpilib.SendableBuilderImpl())


#: The tables whose entries dashboards show.
_TABLES = ("/SmartDashboard/", "/Shuffleboard/")
_SMART_DASHBOARD, _TYPE = "/SmartDashboard/", "/.type"
_CHOOSER = "String Chooser"

#: Whether a field can be shown before there is a robot.
WITHOUT_ROBOT = True


def written_entry(name: str) -> str:
    """Return the entry that a dashboard writes to change this one: itself."""
    return name


def widget_of(name: str) -> DashboardControl | None:
    """Return what the user of a dashboard can change by an entry of this name; None if that is nothing."""
    table, _, entry = name.rpartition("/")
    if not name.startswith(_TABLES) or entry.startswith("."):
        return None
    made_by = network.text_of(f"{table}/.type")
    if made_by == _CHOOSER:
        options = network.texts_of(name) if entry == "options" else []
        return DashboardControl("choice", f"{table}/selected", table, tuple(options)) if options else None
    if made_by == "Command":
        return DashboardControl("command", name, table) if entry == "running" else None
    type_name = network.type_of(name) if made_by else ""
    if type_name == "boolean":
        return DashboardControl("flag", name, name)
    return DashboardControl("number", name, name) if type_name == "double" else None
