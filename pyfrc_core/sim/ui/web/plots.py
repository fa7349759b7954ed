"""Curves of values over time, with about as many points as a plot has pixels."""

from __future__ import annotations

import math
import re
from array import array
from itertools import pairwise
from typing import Any

from ...engine.value_history import MISSING, ValueHistory

_ELEMENT = re.compile(r"(?P<whole>.+)\[(?P<index>\d+)\]")
#: The most points of a curve, whatever is asked for.
MOST_POINTS = 20_000


def element_of(path: str) -> tuple[str, int | None]:
    """Return the path of a list, and the index in it, of a path such as ``joysticks[0].axes[1]``."""
    match = _ELEMENT.fullmatch(path)
    return (path, None) if match is None else (match["whole"], int(match["index"]))


def resolve(history: ValueHistory, path: str) -> tuple[str, int | None]:
    """Return the path that the history has, and the index of an element of its value, or None."""
    whole, index = element_of(path)
    paths = history.paths()
    return (path, None) if index is None or path in paths or whole not in paths else (whole, index)


def picked(value: Any, index: int | None) -> Any:
    """Return an element of a value; `MISSING` if it has none there."""
    if index is None or value is MISSING:
        return value
    return value[index] if isinstance(value, tuple) and index < len(value) else MISSING


def series(history: ValueHistory, path: str, begin: float, end: float, points: int) -> dict[str, Any]:
    """Return the curve of a value: times, values, and the kind of its values.

    A value holds until the next time. If there are more changes than points, the lowest and the highest of each
    interval and those that hold for long are kept, and it says that it is ``thinned``.
    """
    path, index = resolve(history, path)
    points = min(max(points, 2), MOST_POINTS)
    all_times, values = history.changes(path, begin, end)
    plain = isinstance(values, array) and index is None
    found = list(values) if plain else [picked(value, index) for value in values]
    first = picked(history.value_at(path, begin), index)
    if first is not MISSING:
        all_times.insert(0, begin)
        found.insert(0, first)
    kind = "number" if plain and found and type(found[0]) in (float, int) else _kind(found)
    thinned = kind == "number" and len(found) > points
    if thinned:
        all_times, found = _decimated(all_times, found, points)
    elif len(found) > 2 * MOST_POINTS:
        every = math.ceil(len(found) / MOST_POINTS)
        all_times, found = all_times[::every], found[::every]
    values = [None if value is MISSING else value for value in found]
    return {"kind": kind, "t": all_times, "v": values, **({"thinned": True} if thinned else {})}


def _kind(values: list[Any]) -> str:
    kinds = {type(value) for value in values if value is not MISSING}
    if kinds <= {float, int}:
        return "number"
    return "boolean" if kinds == {bool} else "text" if kinds == {str} else "other"


def _decimated(times: list[float], values: list[Any], points: int) -> tuple[list[float], list[Any]]:
    """Keep the first point and the last, the lowest and the highest of each interval, and those that hold for long.

    Where a value is `MISSING`, that point and the next one are kept, too.
    """
    gaps = [number for number, value in enumerate(values) if value is MISSING]
    for number in gaps:  # to compare the others
        values[number] = values[number - 1] if number else 0.0
    intervals = max(points // 3, 1)
    step = len(values) / intervals
    long = (times[-1] - times[0]) / intervals
    held = enumerate(pairwise(times))
    kept = {0, len(values) - 1, *(number for number, (begin, end) in held if end - begin >= long)}
    kept |= {each for number in gaps for each in (number, number + 1) if each < len(values)}
    after = 1
    for number in range(1, intervals + 1):
        begin, after = after, int(number * step)
        if part := values[begin:after]:
            kept |= {begin + part.index(min(part)), begin + part.index(max(part))}
    for number in gaps:
        values[number] = MISSING
    chosen = sorted(kept)
    return [times[each] for each in chosen], [values[each] for each in chosen]


def same(one: Any, other: Any) -> bool:
    """Return whether two values are equal; NaN equals itself."""
    if one is MISSING or other is MISSING:
        return one is other
    return bool(one == other) or (one != one and other != other)  # NaN
