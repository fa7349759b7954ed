"""What dashboards show: fields with the robot on them, and what their user can change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import telemetry
from wpilib import Field2d
from wpimath import Pose2d

from . import network

__all__ = ["Field2d", "place_robot", "robot_pose", "show_field", "show_poses", "shown", "widget_of"]


def robot_pose(field: Field2d) -> Pose2d:
    """Return where the robot is on a field. A dashboard may have moved it."""
    return field.get_robot_pose()


def place_robot(field: Field2d, pose: Pose2d) -> None:
    """Place the robot on a field."""
    field.set_robot_pose(pose)


def show_poses(field: Field2d, name: str, poses: Sequence[Pose2d]) -> None:
    """Show these poses on a field, instead of others of that name."""
    field.get_object(name).set_poses(list(poses))


#: What was given to `show_field`, by its name: Telemetry returns no objects.
_shown: dict[str, Field2d] = {}


def show_field(name: str, field: Field2d) -> None:
    """Show a field on dashboards."""
    _shown[name] = field
    telemetry.log(name, field)


def shown(name: str) -> object | None:
    """Return the object that dashboards show under a name; None if there is none."""
    return _shown.get(name)


#: The tables whose entries dashboards show.
_TABLES = ("/Telemetry/", "/Tunables/")


class Widget(NamedTuple):
    """What the user of a dashboard can change of an object that robot code shows.

    :param kind: a choice, the button of a command, a switch, or a number
    :param entry: the entry that the dashboard writes
    :param owner: what it belongs to: the table of the object, or the entry itself
    :param options: what can be chosen
    """

    kind: Literal["choice", "command", "flag", "number"]
    entry: str
    owner: str
    options: tuple[str, ...] = ()


def widget_of(name: str) -> Widget | None:
    """Return what the user of a dashboard can change by an entry of this name; None if that is nothing."""
    table, _, entry = name.rpartition("/")
    if not name.startswith(_TABLES) or entry.startswith("."):
        return None
    made_by = network.text_of(f"{table}/.type")
    if made_by == "String Chooser":
        options = network.texts_of(name) if entry == "options" else []
        return Widget("choice", f"{table}/selected", table, tuple(options)) if options else None
    if made_by == "Command":
        return Widget("command", name, table) if entry == "running" else None
    type_name = network.type_of(name) if made_by else ""
    if type_name == "boolean":
        return Widget("flag", name, name)
    return Widget("number", name, name) if type_name == "double" else None
