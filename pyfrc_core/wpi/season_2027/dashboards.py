"""What dashboards show: fields with the robot on them, and what their user can change."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import tunables
from wpilib import Field2d
from wpimath import Pose2d

from ..widgets import DashboardControl
from . import network

__all__ = ["Field2d", "place_robot", "robot_pose", "show_field", "show_poses", "shown", "widget_of"]


#: The tables of what dashboards show only, and of what they can change.
_TUNABLES = "/Tunables/"
#: How NetworkTables have a pose.
_POSE = struct.Struct("<3d")


def robot_pose(field: Field2d) -> Pose2d:
    """Return where the robot is on a field. A dashboard may have moved it."""
    return field.get_robot_pose()


def place_robot(field: Field2d, pose: Pose2d) -> None:
    """Place the robot on a field."""
    if field.get_robot_pose() != pose:  # otherwise, what a dashboard has just written would be overwritten
        field.set_robot_pose(pose)


def placed(name: str) -> Pose2d | None:
    """Return where dashboards or scripts have placed the robot on the field of this name; None if they have not."""
    data = network.value_of(f"{_TUNABLES}{name}/Robot")
    if not isinstance(data, bytes) or len(data) != _POSE.size:
        return None
    x, y, angle = _POSE.unpack(data)
    return Pose2d(x, y, angle)


def show_poses(field: Field2d, name: str, poses: Sequence[Pose2d]) -> None:
    """Show these poses on a field, instead of others of that name."""
    field.get_object(name).set_poses(list(poses))


#: What was given to `show_field`, by its name.
_shown: dict[str, Field2d] = {}


def show_field(name: str, field: Field2d) -> None:
    """Show a field on dashboards, where it can be changed: Telemetry would show it once only."""
    if name in _shown:  # by an earlier run in this process
        tunables.remove(name)
    if tunables.publish(name, field):
        _shown[name] = field


def shown(name: str) -> object | None:
    """Return the object that dashboards show under a name; None if there is none."""
    if not network.exists(f"{_TUNABLES}{name}/.type"):
        return None
    return _shown.get(name, name)  # of what robot code has published, no more is known than the name


def forget_shown() -> None:
    """Release the objects that dashboards can change: `tunables` keeps them for as long as the process lives."""
    for entry in network.entry_names():
        if entry.startswith(_TUNABLES) and entry.endswith(_TYPE):
            tunables.remove(entry.removeprefix(_TUNABLES).removesuffix(_TYPE))
    _shown.clear()


_CHOOSER, _TYPE = "Selectable", "/.type"

#: Whether a field can be shown before there is a robot, whose constructor connects tunables to NetworkTables.
WITHOUT_ROBOT = False


def written_entry(name: str) -> str:
    """Return the entry that a dashboard writes to change this one; a robust tunable has another one for it.

    :raises UsageError: when robot code does not let dashboards change it
    """
    return network.written_entry(name, network.properties_of(name))


def widget_of(name: str) -> DashboardControl | None:
    """Return what the user of a dashboard can change by an entry of this name; None if that is nothing."""
    table, _, entry = name.rpartition("/")
    if not name.startswith(_TUNABLES) or entry.startswith("."):
        return None
    made_by = network.text_of(f"{table}/.type")
    if made_by == _CHOOSER:
        options = network.texts_of(name) if entry == "options" else []
        return DashboardControl("choice", f"{table}/selected/tune", table, tuple(options)) if options else None
    if made_by == "Command":
        return DashboardControl("command", name, table) if entry == "running" else None
    type_name = network.type_of(name) if network.properties_of(name).get("mutable") is True else ""
    if type_name == "boolean":
        return DashboardControl("flag", name, name)
    return DashboardControl("number", name, name) if type_name == "double" else None
