"""What follows from the values that stand in ``sim/config.json``: a season's data, older names, a single start."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from .findings import Path
from .seasons import SEASONS, TODAY
from .sim import FieldConfig, Joystick, RobotConfig, SimConfig, SimConfigFile

#: Of a value that is not the file's own: the key in the file that it follows from, or what it is in words.
Origins = dict[Path, Path | str]

_BUTTONS = {1: "Trigger", 2: "Top"}
#: Of a known season these are the field's, whatever the file says.
FROM_SEASON = ("w", "h", "px_per_ft")


def in_effect(given: SimConfig) -> tuple[SimConfig, Origins]:
    """The configuration that holds where `given` is what the file says, and where its derived values come from."""
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


def config_of(document: Mapping[str, Any]) -> SimConfig:
    """The values in effect where ``sim/config.json`` holds this document, ``{"pyfrc": {...}}``.

    :raises pydantic.ValidationError: when something in it is not what it may be
    """
    return in_effect(SimConfigFile.model_validate(document).pyfrc)[0]


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
    season = SEASONS.get(field.season or 0)
    if season is None:
        for name in FROM_SEASON:
            if name not in field.model_fields_set:
                origins["field", name] = f"default: season {TODAY}"
        return field
    names = list(FROM_SEASON)
    if "auto_joysticks" not in field.model_fields_set:
        names.append("auto_joysticks")
    for name in names:
        origins["field", name] = f"season {field.season}"
    return field.model_copy(update={name: getattr(season, name) for name in names})


def _messages(given: SimConfig, origins: Origins) -> tuple[str, ...]:
    season = SEASONS.get(given.field.season or 0)
    if season is None or "game_specific_messages" in given.model_fields_set:
        return given.game_specific_messages
    origins["game_specific_messages",] = f"season {given.field.season}"
    return season.messages


def _joystick(given: Joystick) -> Joystick:
    return given.model_copy(update={"buttons": _BUTTONS | given.buttons})


def without_effect(given: SimConfig) -> Iterator[tuple[Path, str]]:
    """The keys that were given in vain, and why."""
    field, robot = given.field, given.robot
    if field.season in SEASONS:
        for name in FROM_SEASON:
            if name in field.model_fields_set:
                yield ("field", name), f"ignored, since field.season is {field.season}"
    elif field.season is not None:
        known = ", ".join(map(str, SEASONS))
        yield ("field", "season"), f"nothing is known of the season {field.season}; there is: {known}"
    if {"l", "h"} <= robot.model_fields_set and robot.l != robot.h:
        yield ("robot", "h"), "ignored: it is the older name of robot.l, which is there too"
    if len(robot.start_positions) == 1:
        (start,) = robot.start_positions
        for name in ("x", "y", "angle"):
            starting = f"starting_{name}"
            if starting in robot.model_fields_set and getattr(robot, starting) != getattr(start, name):
                yield ("robot", starting), "ignored: the only one of robot.start_positions is taken"
