"""The values of a log: columns that are decoded when they are looked at."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, KeysView, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from types import MappingProxyType
from typing import Any

from ..engine.past_run import Happened
from ..engine.value_history import MISSING, ValueHistory

_MICRO = 1_000_000


@dataclass(frozen=True)
class Column:
    """The changes of one value.

    :param moments: when it changed, in microseconds of the log's clock, in order
    :param decode: returns the values of the changes from one number until before another; `MISSING` for what is damaged
    :param has_end: whether the last change is the end of its log
    """

    moments: array[int]
    decode: Callable[[int, int], Sequence[Any]]
    has_end: bool = False

    @classmethod
    def of(cls, moments: Iterable[int], values: Sequence[Any]) -> Column:
        """Return a column of values that are known, without those that repeat the one before."""
        kept, found = array("q"), []
        before: Any = MISSING
        for moment, value in zip(moments, values, strict=True):
            if value != before or type(value) is not type(before):
                kept.append(moment)
                found.append(value)
                before = value
        return cls(kept, lambda begin, end: found[begin:end])

    def moments_later(self, by: int) -> array[int]:
        """Return its moments, this many microseconds later."""
        return array("q", (moment + by for moment in self.moments))

    def until(self, end: int) -> Column:
        """Return the column, with a value that is gone after a moment, at which its log has ended."""
        count = len(self.moments)

        def decode(first: int, last: int) -> Sequence[Any]:
            values = self.decode(first, min(last, count)) if first < count else []
            return [*values, MISSING] if first <= count < last else values

        return Column(self.moments + array("q", [end + 1]), decode, has_end=True)

    def values(self) -> Sequence[Any]:
        """Return all values."""
        return self.decode(0, len(self.moments))

    def at(self, moment: int) -> Any:
        """Return the value at a moment; `MISSING` if there was none."""
        after = bisect_right(self.moments, moment)
        return self.decode(after - 1, after)[0] if after else MISSING

    def last(self) -> Any:
        """Return the value when its log has ended; `MISSING` if there was none."""
        after = len(self.moments) - self.has_end
        return self.decode(after - 1, after)[0] if after else MISSING


@dataclass
class ReadLog:
    """What a reader has found in a file.

    :param columns: by the names that the file has for them
    :param types: those of its entries, as NetworkTables name them: ``double``, ``struct:Pose2d[]``
    :param happened: in seconds of the log's clock
    :param problem: what is wrong with the file, as a sentence; empty: nothing
    :param when: when the log's clock was 0, if that is known
    :param begin: the moment that is shown as 0, if it is not that of the first value
    """

    columns: dict[str, Column] = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    happened: list[Happened] = field(default_factory=list)
    problem: str = ""
    when: datetime | None = None
    begin: int | None = None


class LogHistory(ValueHistory):
    """The values of a log, to which nothing is added. Its packets have the numbers of the log's microseconds.

    :param columns: by path
    :param begin: the moment that is shown as 0; what is earlier is shown there, too
    :param end: its last moment
    """

    def __init__(self, columns: Mapping[str, Column], begin: int, end: int) -> None:
        super().__init__()
        self._columns, self._begin, self._end = columns, begin, end

    @cached_property
    def now(self) -> MappingProxyType[str, Any]:
        """All values at the end; of two logs on one line, of which one ends first, at the end of each."""
        found = ((path, column.last()) for path, column in self._columns.items())
        return MappingProxyType({path: value for path, value in found if value is not MISSING})

    @property
    def count(self) -> int:
        """The number of all changes."""
        return sum(len(column.moments) for column in self._columns.values())

    @property
    def known_from(self) -> float:
        """The time from which on values are known."""
        return 0.0

    @property
    def end(self) -> float:
        """The time of the last change."""
        return self._seconds(self._end)

    @cached_property
    def _moments(self) -> list[int]:
        return sorted(set().union(*(column.moments for column in self._columns.values())))

    @property
    def times(self) -> array[float]:
        """The times of all changes."""
        return array("d", map(self._seconds, self._moments))

    @property
    def packets(self) -> int:
        """The number after that of the last packet."""
        return self._end + 1

    @property
    def size(self) -> int:
        """About how many bytes it takes, of those that can be forgotten."""
        return 0

    def forget_oldest(self) -> bool:
        """Forget nothing: a reader limits what a log takes."""
        return False

    def values_at(self, time: float) -> dict[str, Any]:
        """Return all values at a moment."""
        moment = self._packet_at(time)
        values = ((path, column.at(moment)) for path, column in self._columns.items())
        return {path: value for path, value in values if value is not MISSING}

    def value_at(self, path: str, time: float) -> Any:
        """Return one value at a moment; `MISSING` if there was none."""
        column = self._columns.get(path)
        return MISSING if column is None else column.at(self._packet_at(time))

    def paths(self) -> KeysView[str]:
        """Return the paths of all values."""
        return self._columns.keys()

    def changed_since(self, packet: int) -> dict[str, Any]:
        """Return all values to a reader that has none yet."""
        return dict(self.now) if packet <= 0 else {}

    def change_count(self, path: str) -> int:
        """Return how often a value was logged."""
        return len(self._columns[path].moments)

    def change_numbers(self, path: str) -> list[int]:
        """Return which of the times have changed a value."""
        moments = self._moments
        return [bisect_left(moments, moment) for moment in self._columns[path].moments]

    def _packet_at(self, time: float) -> int:
        return int(time * _MICRO) + self._begin

    def _seconds(self, moment: int) -> float:
        return max(moment - self._begin, 0) / _MICRO

    def _between(self, path: str, first: int, last: int) -> tuple[list[float], Any]:
        column = self._columns.get(path)
        if column is None:
            return [], []
        begin, end = bisect_left(column.moments, first), bisect_right(column.moments, last)
        values = column.decode(begin, end)
        times = list(map(self._seconds, column.moments[begin:end]))
        if values and all(type(value) is float for value in values):
            return times, array("d", values)
        return times, list(values)
