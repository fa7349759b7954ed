"""Where two runs first differ."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

from .history import MISSING, History
from .plots import picked, resolve

#: The most paths that are named.
_MOST_NAMED = 20


class FirstDifference:
    """The earliest difference that was found, and where.

    :param begin: look after this moment, in seconds of robot time; `end` is the last one
    """

    def __init__(self, begin: float, end: float) -> None:
        self._begin, self._end = begin, end
        #: None: there is none.
        self.time: float | None = None
        self.paths: list[str] = []

    def compare(self, one: History, other: History, path: str) -> None:
        """Look for an earlier difference in this value."""
        time = self._difference(one, other, path)
        if time is None:
            return
        if self.time is None or time < self.time:
            self.time, self.paths = time, []
            self._end = time  # later ones no longer matter
        if len(self.paths) < _MOST_NAMED:
            self.paths.append(path)

    def _difference(self, one: History, other: History, path: str) -> float | None:
        changes = zip_longest(
            _changes(one, path, self._begin, self._end), _changes(other, path, self._begin, self._end)
        )
        for left, right in changes:
            if left is None or right is None or left[0] != right[0]:
                return min(change[0] for change in (left, right) if change is not None)
            if not _same(left[1], right[1]):
                return float(left[0])
        return None


def _changes(history: History, path: str, begin: float, end: float) -> Iterator[tuple[float, Any]]:
    """Yield the value at the beginning, and each later change of it."""
    whole, index = resolve(history, path)
    before = picked(history.value_at(whole, begin), index)
    yield begin, before
    for time, each in zip(*history.changes(whole, begin, end), strict=True):
        value = picked(each, index)
        if not _same(value, before):
            before = value
            yield time, value


def _same(one: Any, other: Any) -> bool:
    if one is MISSING or other is MISSING:
        return one is other
    return bool(one == other) or (one != one and other != other)  # NaN
