"""Resolve the values of ``sim/config.json``: add a season's field, older names and the only start position."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..season import CURRENT, FIELDS
from .findings import Path
from .sim import FieldConfig, Joystick, RobotConfig, SimConfig, SimConfigFile

#: Where each derived value comes from: the path of another key in the file, or a description.
Origins = dict[Path, Path | str]

_BUTTONS = {CURRENT.first_button: "Trigger", CURRENT.first_button + 1: "Top"}
#: A known season decides these keys of the field, whatever the file says.
FROM_SEASON = ("w", "h", "px_per_ft")


def resolve(given: SimConfig) -> tuple[SimConfig, Origins]:
    """Return the values in effect, and the origins of those that `given` does not contain.

    :param given: what the file says
    """
    origins: Origins = {}
    config = given.model_copy(
        update={
            "robot": _robot(given.robot, origins),
            "field": _field(given.field, origins),
            "game_specific_messages": _messages(given, origins),
            "joysticks": {port: _joystick(given.joysticks.get(port, Joystick())) for port in range(6)},
        }
    )
    return config, origins


def resolve_document(document: Mapping[str, object]) -> SimConfig:
    """Return the values in effect for the content of ``sim/config.json``, ``{"pyfrc": {...}}``.

    :raises pydantic.ValidationError: when a value is not allowed
    """
    return resolve(SimConfigFile.model_validate(document).pyfrc)[0]


def _robot(robot: RobotConfig, origins: Origins) -> RobotConfig:
    update: dict[str, Any] = {}
    if "l" not in robot.model_fields_set and "h" in robot.model_fields_set:
        update["l"] = robot.h
        origins["robot", "l"] = ("robot", "h")
    if len(robot.start_positions) == 1:
        (start,) = robot.start_positions
        for name in ("x", "y", "angle"):
            update[f"starting_{name}"] = getattr(start, name)
            is_given = name in start.model_fields_set
            origins["robot", f"starting_{name}"] = ("robot", "start_positions", 0, name) if is_given else "default"
    return robot.model_copy(update={"h": update.get("l", robot.l), **update})


def _field(field: FieldConfig, origins: Origins) -> FieldConfig:
    season = FIELDS.get(field.season or 0)
    if season is None:
        for name in FROM_SEASON:
            if name not in field.model_fields_set:
                origins["field", name] = f"default: season {CURRENT.year}"
        return field
    names = list(FROM_SEASON)
    if "auto_joysticks" not in field.model_fields_set:
        names.append("auto_joysticks")
    for name in names:
        origins["field", name] = f"season {field.season}"
    return field.model_copy(update={name: getattr(season, name) for name in names})


def _messages(given: SimConfig, origins: Origins) -> tuple[str, ...]:
    season = FIELDS.get(given.field.season or 0)
    if season is None or "game_specific_messages" in given.model_fields_set:
        return given.game_specific_messages
    origins["game_specific_messages",] = f"season {given.field.season}"
    return season.messages


def _joystick(given: Joystick) -> Joystick:
    return given.model_copy(update={"buttons": _BUTTONS | given.buttons})


def ignored_keys(given: SimConfig) -> Iterator[tuple[Path, str]]:
    """Yield the keys of the file that have no effect, each with the reason."""
    field, robot = given.field, given.robot
    if field.season in FIELDS:
        for name in FROM_SEASON:
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
