"""What those entries of data logs hold whose names are known, whatever types they have in a log.

The types have changed over the years: until 2022, ``FMSControlData`` was a double. And a team may give such a name to
an entry of its own. So a value is converted to what its name says; one that cannot be is none.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache
from typing import Any

#: Converts a value; None: it cannot be one of this entry.
Fit = Callable[[Any], Any]


def _number(make: Callable[[float], Any] = float, low: float = -math.inf, high: float = math.inf) -> Fit:
    def fit(value: object) -> Any:
        is_number = isinstance(value, (int, float)) and math.isfinite(value)
        return make(value) if is_number and low <= value <= high else None  # type: ignore[operator, arg-type]

    return fit


def whole(low: int, high: int) -> Fit:
    """Return what converts to whole numbers of a range."""
    return _number(int, low, high)


def _text(value: object) -> str | None:
    return value.partition("\0")[0] if isinstance(value, str) else None


def _each(fit: Fit) -> Fit:
    def fit_all(value: object) -> tuple[Any, ...] | None:
        found = tuple(map(fit, value)) if isinstance(value, (tuple, list)) else (None,)
        return None if None in found else found

    return fit_all


_flag, _axis = _number(bool), _number(lambda axis: min(max(float(axis), -1.0), 1.0))
_STATION = r"NT:/(?:FMSInfo|DriverStation)/"
_WORD = rf"(?:DS:controlWord|{_STATION}ControlWord)/"
_HAL = r"/hal_data/"
_FITS: tuple[tuple[str, Fit], ...] = (
    (rf"DS:(enabled|autonomous|test|estop)|{_WORD}(enabled|eStop)|{_STATION}IsRedAlliance", _flag),
    (rf"{_HAL}control\.(enabled|autonomous|test|eStop|dsAttached|fmsAttached)", _flag),
    (rf"{_STATION}FMSControlData|{_WORD}robotMode", whole(0, (1 << 31) - 1)),
    (rf"{_STATION}(StationNumber|MatchType)|{_HAL}event\.match_type", whole(0, 3)),
    (rf"{_HAL}alliance_station", whole(0, 6)),
    (rf"{_STATION}MatchNumber|{_HAL}event\.match_number", whole(0, 65535)),
    (rf"{_STATION}(EventName|GameSpecificMessage|GameData)", _text),
    (rf"DS:opMode|{_HAL}(control\.opmode|event\.(name|game_specific_message))", _text),
    (rf"{_HAL}time\.remaining", _number()),
    (r"DS:joystick[0-5]/axes", _each(_axis)),
    (r"DS:joystick[0-5]/buttons", _each(_flag)),
    (r"DS:joystick[0-5]/povs", _each(whole(-1, 360))),
)


@cache
def fit_of(name: str) -> Fit | None:
    """Return what converts the values of an entry; None for one whose name is not known."""
    return next((fit for names, fit in _FITS if re.fullmatch(names, name)), None)
