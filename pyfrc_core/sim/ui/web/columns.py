"""Every change of one value over some packets, as arrays."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from typing import Any


class _Missing:
    """The type of `MISSING`, which is the same object after it was pickled."""

    def __reduce__(self) -> str:
        return "MISSING"


#: A value that a path has not, or no longer.
MISSING: Any = _Missing()

#: About the size of an object in a column, of a dict in it, and of a column without changes, in bytes.
_OBJECT_SIZE, _DICT_SIZE, _COLUMN_SIZE = 120, 280, 400
#: After how many objects their size is estimated again.
_SIZED = 64


def _storage_of(value: Any) -> str:
    """Return how a value is stored: ``number``, ``boolean``, ``vector`` (a tuple of numbers) or ``object``."""
    kind = type(value)
    if kind is float or (kind is int and abs(value) < 1 << 53):
        return "number"
    if kind is bool:
        return "boolean"
    if kind is tuple and value and all(type(each) is float for each in value):
        return "vector"
    return "object"


def _size_of(value: Any) -> int:
    """Return about how many bytes an object takes, such as a struct, which has dicts in dicts."""
    if isinstance(value, Mapping):
        return _DICT_SIZE + sum(map(_size_of, value.values()))
    if isinstance(value, tuple):
        return _OBJECT_SIZE + sum(map(_size_of, value))
    return _OBJECT_SIZE if isinstance(value, str) else 24


class Column:
    """The changes of one value, in the order of packets. Packets are given by their numbers within a chunk."""

    def __init__(self, value: Any) -> None:
        self._storage = _storage_of(value)
        self.packets = array("I")
        self._numbers = array("d")
        #: Of a vector: where each value ends among the numbers.
        self._ends = array("I")
        self._objects: list[Any] = []
        self._object_size = 0

    def append(self, packet: int, value: Any) -> None:
        """Add a change."""
        storage = self._storage
        if storage == "number" and type(value) is float:  # most changes are of this kind
            self.packets.append(packet)
            self._numbers.append(value)
            return
        if storage != _storage_of(value) and storage != "object":
            self._objects = [self.value(number) for number in range(len(self.packets))]
            self._object_size = _size_of(value)
            self._storage = storage = "object"
            self._numbers, self._ends = array("d"), array("I")
        self.packets.append(packet)
        if storage == "vector":
            self._numbers.extend(value)
            self._ends.append(len(self._numbers))
        elif storage == "object":
            if not len(self._objects) % _SIZED:
                self._object_size = max(self._object_size, _size_of(value), _OBJECT_SIZE)
            self._objects.append(value)
        else:
            self._numbers.append(value)

    def __len__(self) -> int:
        return len(self.packets)

    @property
    def size(self) -> int:
        """About how many bytes it takes."""
        arrays = 4 * len(self.packets) + 8 * len(self._numbers) + 4 * len(self._ends)
        return _COLUMN_SIZE + arrays + self._object_size * len(self._objects)

    def value(self, number: int) -> Any:
        """Return the value after the change with this number."""
        if self._storage == "vector":
            return tuple(self._numbers[self._ends[number - 1] if number else 0 : self._ends[number]])
        if self._storage == "object":
            return self._objects[number]
        found = self._numbers[number]
        return found != 0 if self._storage == "boolean" else found

    def value_at(self, packet: int, default: Any) -> Any:
        """Return the value after a packet; the default if there was no change until then."""
        number = bisect_right(self.packets, packet)
        return self.value(number - 1) if number else default

    def between(self, first: int, last: int) -> tuple[int, int]:
        """Return the numbers of the changes in these packets: the first, and the one after the last."""
        return bisect_left(self.packets, first), bisect_right(self.packets, last)

    def numbers(self, begin: int, end: int) -> array[float] | None:
        """Return these changes as numbers; None if they are something else, or true and false."""
        return self._numbers[begin:end] if self._storage == "number" else None

    def until(self, packet: int) -> Column | None:
        """Return a copy of the changes until a packet; None if there are none."""
        end = bisect_right(self.packets, packet)
        if not end:
            return None
        part = Column(self.value(0))
        part._storage, part.packets = self._storage, self.packets[:end]
        part._ends, part._objects, part._object_size = self._ends[:end], self._objects[:end], self._object_size
        part._numbers = self._numbers[: self._ends[end - 1] if self._ends else end]
        return part
