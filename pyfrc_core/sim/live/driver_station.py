"""What a robot publishes of its driver station: its mode, its alliance, the seconds left.

WPILib publishes a word of bits, in a table that has another name from 2027 on. It publishes no seconds left: teams and
their libraries do, under names such as ``Match Time``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...runtime.scripts.modes import (
    AUTONOMOUS,
    DS_ATTACHED,
    ENABLED,
    SELECTED_BY_NUMBER,
    STOPPED,
    TEST,
    mode_name,
    selected,
)
from ..engine.messages import UNKNOWN_MODE, VALUE

_TABLES = (f"{VALUE}/FMSInfo", f"{VALUE}/DriverStation")
#: The parts of the word from 2027 on that are as its bits until 2026.
_FLAGS = ("enabled", "eStop", "dsAttached")
#: The name of a topic with the seconds left, in small letters without spaces and the like.
_MATCH_TIME = "matchtime"


@dataclass(frozen=True)
class DriverStation:
    """The state of the driver station, as the robot publishes it.

    :param mode: as in `Snapshot.mode`, or one of `NO_CONNECTION` and `UNKNOWN_MODE`
    :param alliance_station: the number that `hal_data` has; 0: unknown
    """

    mode: str
    attached: bool = True
    emergency_stopped: bool = False
    alliance_station: int = 0
    game_message: str = ""


def driver_station_in(values: Mapping[str, Any]) -> DriverStation:
    """Return the state of the driver station in a robot's values, by path."""
    before, after = _TABLES
    word = values.get(f"{before}/FMSControlData")
    if isinstance(word, int):
        flags = bool(word & ENABLED), bool(word & STOPPED), bool(word & DS_ATTACHED)
        return _station(before, values, selected(word & AUTONOMOUS, word & TEST), flags, "GameSpecificMessage")
    word_path = f"{after}/ControlWord"
    if f"{word_path}/enabled" in values:
        chosen = SELECTED_BY_NUMBER.get(values.get(f"{word_path}/robotMode", 0), "")
        enabled, stopped, attached = (bool(values.get(f"{word_path}/{name}")) for name in _FLAGS)
        return _station(after, values, chosen, (enabled, stopped, attached), "GameData")
    return DriverStation(UNKNOWN_MODE)


def _station(
    table: str, values: Mapping[str, Any], chosen: str, flags: tuple[bool, bool, bool], message: str
) -> DriverStation:
    enabled, stopped, attached = flags
    place = values.get(f"{table}/StationNumber")
    is_red = bool(values.get(f"{table}/IsRedAlliance", True))
    return DriverStation(
        mode=mode_name(enabled, chosen),
        attached=attached,
        emergency_stopped=stopped,
        alliance_station=place + (0 if is_red else 3) if isinstance(place, int) and 1 <= place <= 3 else 0,
        game_message=str(values.get(f"{table}/{message}", "")),
    )


def is_match_time(path: str) -> bool:
    """Return whether a value is called the seconds left in the match."""
    name = path.rpartition("/")[2].casefold()
    return path.startswith(VALUE) and "".join(filter(str.isalnum, name)) == _MATCH_TIME
