"""Resolve the values of ``sim/config.json``: add a season's field, older names and the only start position."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..season import CURRENT, FIELDS
from .findings import Path
from .sim import FieldConfig, Joystick, RobotConfig, SimConfig, SimConfigFile

_BUTTONS = {CURRENT.first_button: "Trigger", CURRENT.first_button + 1: "Top"}
#: A known season decides these keys of the field, whatever the file says.
_FROM_SEASON = ("w", "h", "px_per_ft")


def resolve(given: SimConfig) -> SimConfig:
    """Return the values in effect, where `given` is what the file says."""
    return given.model_copy(
        update={
            "robot": _robot(given.robot),
            "field": _field(given.field),
            "game_specific_messages": _messages(given),
            "joysticks": {port: _joystick(given.joysticks.get(port, Joystick())) for port in range(6)},
        }
    )


def resolve_document(document: Mapping[str, object]) -> SimConfig:
    """Return the values in effect for the content of ``sim/config.json``, ``{"pyfrc": {...}}``.

    :raises pydantic.ValidationError: when a value is not allowed
    """
    return resolve(SimConfigFile.model_validate(document).pyfrc)


def _robot(robot: RobotConfig) -> RobotConfig:
    update: dict[str, Any] = {}
    if "l" not in robot.model_fields_set and "h" in robot.model_fields_set:
        update["l"] = robot.h
    if len(robot.start_positions) == 1:
        (start,) = robot.start_positions
        update |= {f"starting_{name}": getattr(start, name) for name in ("x", "y", "angle")}
    return robot.model_copy(update={"h": update.get("l", robot.l), **update})


def _field(field: FieldConfig) -> FieldConfig:
    season = FIELDS.get(field.season or 0)
    if season is None:
        return field
    names = list(_FROM_SEASON)
    if "auto_joysticks" not in field.model_fields_set:
        names.append("auto_joysticks")
    return field.model_copy(update={name: getattr(season, name) for name in names})


def _messages(given: SimConfig) -> tuple[str, ...]:
    season = FIELDS.get(given.field.season or 0)
    if season is None or "game_specific_messages" in given.model_fields_set:
        return given.game_specific_messages
    return season.messages


def _joystick(given: Joystick) -> Joystick:
    return given.model_copy(update={"buttons": _BUTTONS | given.buttons})


def ignored_keys(given: SimConfig) -> Iterator[tuple[Path, str]]:
    """Yield the keys of the file that have no effect, each with the reason."""
    field, robot = given.field, given.robot
    if field.season in FIELDS:
        for name in _FROM_SEASON:
            if name in field.model_fields_set:
                yield ("field", name), f"ignored, since field.season is {field.season}"
    elif field.season is not None:
        known = ", ".join(map(str, FIELDS))
        yield ("field", "season"), f"nothing is known of the season {field.season}; there is: {known}"
    if {"l", "h"} <= robot.model_fields_set and robot.l != robot.h:
        yield ("robot", "h"), "ignored: it is the older name of robot.l, which is there too"
    if len(robot.start_positions) == 1:
        (start,) = robot.start_positions
        for name in ("x", "y", "angle"):
            starting = f"starting_{name}"
            if starting in robot.model_fields_set and getattr(robot, starting) != getattr(start, name):
                yield ("robot", starting), "ignored: the only one of robot.start_positions is taken"
