"""The history of a run in as little space as possible: what a page without a server has instead of one.

A value's changes are columns: the packets in which it changed, and its numbers. All else in a value, such as the texts
and the names in a struct, is its shape, in which each number is replaced by 0; most values have one shape. A number is
stored as an integer, with as many decimals as `_DIGITS` digits of the column's largest number need, and as the
difference from the one before: gzip then finds little to store.
"""

from __future__ import annotations

import json
import math
from array import array
from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise
from typing import Any

from ...engine.messages import TYPE
from .history import MISSING, ValueHistory

#: The digits of a number that are kept: more than a plot or a panel shows.
_DIGITS = 7
_MOST_DECIMALS = 12
#: The shape of a value that no longer exists.
_GONE = {"$": "gone"}


def packed(history: ValueHistory, clean: Callable[[str], str]) -> dict[str, Any]:
    """Return a history for a page.

    :param clean: changes each text
    """
    columns: dict[str, _PackedColumn] = {}
    for path in history.paths():
        if path.startswith(TYPE):
            continue
        columns[path] = column = _PackedColumn(clean)
        packets, (_, values) = history.change_numbers(path), history.changes(path)
        if isinstance(values, array) and all(map(math.isfinite, values)):
            column.add_numbers(packets, values)
        else:
            for packet, value in zip(packets, values, strict=True):
                column.add(packet, value)
    times = [round(time * 1_000_000) for time in history.times]
    return {"times": _differences(times), "values": {path: column.plain() for path, column in columns.items()}}


class _PackedColumn:
    """The changes of one value.

    :param clean: changes each text
    """

    def __init__(self, clean: Callable[[str], str]) -> None:
        self._clean = clean
        self._packets: list[int] = []
        #: The number of each shape, by its JSON; and that of each change.
        self._shapes: dict[str, int] = {}
        self._shape_numbers: list[int] = []
        #: The first numbers of all values that have numbers, the second ones, and so on.
        self._numbers: list[list[float]] = []

    def add(self, packet: int, value: Any) -> None:
        """Add a change."""
        numbers: list[float] = []
        shape = json.dumps(self._shape_of(value, numbers), separators=(",", ":"))
        self._packets.append(packet)
        self._shape_numbers.append(self._shapes.setdefault(shape, len(self._shapes)))
        while len(self._numbers) < len(numbers):
            self._numbers.append([])
        for column, number in zip(self._numbers, numbers, strict=False):
            column.append(number)

    def add_numbers(self, packets: Iterable[int], numbers: Iterable[float]) -> None:
        """Add changes of a value that is a finite number."""
        if not self._numbers:
            self._numbers.append([])
        before = len(self._packets)
        self._packets += packets
        self._numbers[0] += numbers
        self._shape_numbers += [self._shapes.setdefault("0", len(self._shapes))] * (len(self._packets) - before)

    def _shape_of(self, value: Any, numbers: list[float]) -> Any:
        """Return a value with 0 for each number, which is added to a list."""
        if value is MISSING:
            return _GONE
        if isinstance(value, bool) or value is None:
            return value
        if isinstance(value, (int, float)):
            if math.isfinite(value):
                numbers.append(value)
                return 0
            return {"$": "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"}
        if isinstance(value, Mapping):
            return {self._clean(str(key)): self._shape_of(each, numbers) for key, each in value.items()}
        if isinstance(value, (list, tuple)):
            return [self._shape_of(each, numbers) for each in value]
        return self._clean(str(value))

    def plain(self) -> dict[str, Any]:
        """Return it for a page: packets, shapes, the shape of each change if there are several, numbers."""
        found: dict[str, Any] = {"p": _differences(self._packets), "s": [json.loads(shape) for shape in self._shapes]}
        if len(self._shapes) > 1:
            found["i"] = self._shape_numbers
        if self._numbers:
            found["n"] = [_packed_numbers(column) for column in self._numbers]
        return found


def _packed_numbers(numbers: list[float]) -> list[int]:
    """Return the number of decimals, the first number as an integer of these, and the differences."""
    largest = max(max(numbers), -min(numbers))
    if all(number == int(number) for number in numbers) or not largest:
        decimals = 0
    else:
        decimals = min(max(_DIGITS - math.ceil(math.log10(largest)), 0), _MOST_DECIMALS)
    scale = 10**decimals
    return [decimals, *_differences([round(number * scale) for number in numbers])]


def _differences(numbers: list[int]) -> list[int]:
    """Return the first number and the differences of those after it."""
    return [*numbers[:1], *(after - before for before, after in pairwise(numbers))]
