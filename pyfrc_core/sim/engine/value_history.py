"""Every changed value of every packet of a run, in memory, so that any moment and any plot is there at once.

Memory is limited: `sim.ui.web.runs` forgets former runs and then the oldest packets, and pages say from when on values
are known.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator, KeysView, Mapping
from types import MappingProxyType
from typing import Any

from .messages import TYPE

#: A value that a path does not have, or no longer has.
MISSING: Any = object()

#: About the size of an object, of a dict, and of the changes of one value besides the values, in bytes.
_OBJECT_SIZE, _DICT_SIZE, _CHANGES_SIZE = 120, 280, 400
#: After how many objects their size is estimated again.
_SIZED = 64
#: The share of the packets that is forgotten at once.
_FORGOTTEN = 1 / 8


def _size_of(value: Any) -> int:
    """Return about how many bytes an object takes, such as a struct, which has dicts in dicts."""
    if isinstance(value, Mapping):
        return _DICT_SIZE + sum(map(_size_of, value.values()))
    if isinstance(value, tuple):
        return _OBJECT_SIZE + sum(map(_size_of, value))
    return _OBJECT_SIZE if isinstance(value, str) else 24


class ValueChanges:
    """The changes of one value: the numbers of packets, and the value after each.

    Most values are numbers, which take 8 bytes each in an array. Other values are objects in a list.
    """

    def __init__(self) -> None:
        self.packets = array("I")
        self.values: array[float] | list[Any] = array("d")
        self._object_size = 0

    def append(self, packet: int, value: Any) -> None:
        """Add a change."""
        values = self.values
        if isinstance(values, array):
            if type(value) is float or (type(value) is int and abs(value) < 1 << 53):
                self.packets.append(packet)
                values.append(value)
                return
            self.values = values = list(values)
        if not len(values) % _SIZED or not self._object_size:
            self._object_size = max(self._object_size, 8 + _size_of(value))
        self.packets.append(packet)
        values.append(value)

    @property
    def size(self) -> int:
        """About how many bytes it takes."""
        each = 8 if isinstance(self.values, array) else self._object_size
        return _CHANGES_SIZE + (self.packets.itemsize + each) * len(self.packets)

    def at(self, packet: int) -> Any:
        """Return the value after a packet; `MISSING` if there was no change until then."""
        after = bisect_right(self.packets, packet)
        return self.values[after - 1] if after else MISSING

    def until(self, packet: int) -> ValueChanges:
        """Return a copy of the changes until a packet."""
        part, end = ValueChanges(), bisect_right(self.packets, packet)
        part.packets, part.values, part._object_size = self.packets[:end], self.values[:end], self._object_size
        return part

    def forget_before(self, packet: int) -> None:
        """Forget the changes before a packet; the value that it began with counts as its change."""
        if before := bisect_right(self.packets, packet):
            del self.packets[: before - 1], self.values[: before - 1]
            self.packets[0] = packet


class ValueHistory:
    """The values of one run. Use it from one thread at a time."""

    def __init__(self) -> None:
        self._times = array("d")
        #: The number of the first packet that is known; packets count from 0.
        self._first = 0
        self._changes: dict[str, ValueChanges] = {}
        self._now: dict[str, Any] = {}

    @property
    def now(self) -> MappingProxyType[str, Any]:
        """All values after the last change."""
        return MappingProxyType(self._now)

    @property
    def known_from(self) -> float:
        """The time from which on values are known: 0 until the oldest are forgotten."""
        return self._times[0] if self._first and self._times else 0.0

    @property
    def end(self) -> float:
        """The time of the last change."""
        return self._times[-1] if self._times else 0.0

    @property
    def times(self) -> array[float]:
        """The times of all packets that are known."""
        return self._times

    @property
    def packets(self) -> int:
        """The number of packets so far, also of those that are forgotten."""
        return self._first + len(self._times)

    @property
    def size(self) -> int:
        """About how many bytes it takes."""
        return 8 * len(self._times) + sum(changes.size for changes in self._changes.values())

    def add(self, time: float, values: Mapping[str, Any], gone: Iterable[str] = ()) -> None:
        """Add the changes of one packet, which is not earlier than those before."""
        packet, known = self.packets, self._changes
        self._times.append(time)
        for path, value in values.items():
            changes = known.get(path)
            if changes is None:
                changes = known[path] = ValueChanges()
            changes.append(packet, value)
        self._now.update(values)
        for path in gone:
            if self._now.pop(path, MISSING) is not MISSING:
                known[path].append(packet, MISSING)

    def forget_oldest(self) -> bool:
        """Forget some of the oldest packets, and return whether there were any besides the last."""
        count = min(int(len(self._times) * _FORGOTTEN) + 1, len(self._times) - 1)
        if count <= 0:
            return False
        del self._times[:count]
        self._first += count
        for path, changes in list(self._changes.items()):
            changes.forget_before(self._first)
            if len(changes.values) == 1 and changes.values[0] is MISSING:
                del self._changes[path]
        return True

    def until(self, time: float) -> ValueHistory:
        """Return a copy of the part until a moment, which can grow differently."""
        part, last = ValueHistory(), self._packet_at(time)
        part._first, part._times = self._first, self._times[: last + 1 - self._first]
        copies = ((path, changes.until(last)) for path, changes in self._changes.items())
        part._changes = {path: changes for path, changes in copies if changes.packets}
        part._now = part.values_at(time)
        return part

    def values_at(self, time: float) -> dict[str, Any]:
        """Return all values at a moment; those at the first known moment if it is earlier."""
        packet = max(self._packet_at(time), self._first)
        values = ((path, changes.at(packet)) for path, changes in self._changes.items())
        return {path: value for path, value in values if value is not MISSING}

    def value_at(self, path: str, time: float) -> Any:
        """Return one value at a moment; `MISSING` if there was none."""
        changes = self._changes.get(path)
        return MISSING if changes is None else changes.at(self._packet_at(time))

    def _packet_at(self, time: float) -> int:
        """Return the number of the last packet until a moment; the one before the first if there is none."""
        return self._first + bisect_right(self._times, time) - 1

    def paths(self) -> KeysView[str]:
        """Return the paths of all values that there were."""
        return self._changes.keys()

    def changes(self, path: str, begin: float = -1.0, end: float | None = None) -> tuple[list[float], Any]:
        """Return the changes of a value after one moment, until another one: their times, and the values."""
        last = self.packets if end is None else self._packet_at(end)
        return self._between(path, self._packet_at(begin) + 1, last)

    def moves(self, path: str) -> bool:
        """Return whether a value has had different values."""
        values = self.changes(path)[1]
        return any(value != values[0] for value in values)

    def changed_since(self, packet: int) -> dict[str, Any]:
        """Return the values that have changed since the packet with this number; `MISSING` for those that are gone."""
        changed = (path for path, changes in self._changes.items() if changes.packets[-1] >= packet)
        return {path: self._now.get(path, MISSING) for path in changed}

    def since(self, packet: int, path: str) -> Iterator[tuple[float, Any]]:
        """Yield a value's changes from the packet with this number on: their times, and the values."""
        return zip(*self._between(path, packet, self.packets), strict=True)

    def _between(self, path: str, first: int, last: int) -> tuple[list[float], Any]:
        changes = self._changes.get(path)
        if changes is None:
            return [], []
        begin, end = bisect_left(changes.packets, first), bisect_right(changes.packets, last)
        return [self._times[packet - self._first] for packet in changes.packets[begin:end]], changes.values[begin:end]

    def change_count(self, path: str) -> int:
        """Return how often a value has changed, as far as it is known."""
        return len(self._changes[path].packets)

    def change_numbers(self, path: str) -> list[int]:
        """Return which of the packets that are known have changed a value: 0 is the first of `times`."""
        return [packet - self._first for packet in self._changes[path].packets]


#: The digits of a number that are kept: more than a plot or a panel shows.
_DIGITS = 7


def packed(history: ValueHistory, clean: Callable[[str], str]) -> dict[str, Any]:
    """Return the times of all packets; and for each value the packets in which it changed, and what it was then.

    :param clean: changes each text
    """
    values = {}
    for path in history.paths():
        if not path.startswith(TYPE):
            changes = [_plain(value, clean) for value in history.changes(path)[1]]
            values[path] = {"p": history.change_numbers(path), "v": changes}
    return {"times": [round(time, 6) for time in history.times], "values": values}


def _plain(value: Any, clean: Callable[[str], str]) -> Any:
    if value is MISSING:
        return {"$": "gone"}
    if value is None or isinstance(value, (bool, int)):
        return value
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}")
    if isinstance(value, Mapping):
        return {clean(str(key)): _plain(each, clean) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each, clean) for each in value]
    return clean(str(value))
