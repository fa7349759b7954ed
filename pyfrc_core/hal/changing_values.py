"""Reads many values of the HAL, in a time that depends on how many of them are written.

A value of a SimDevice is read only after the HAL has reported a write, which takes less time than a read.

The other devices' values are read at each look. Their number is limited by the roboRIO, and their callbacks are lost
without a sign when code resets their data.
"""

from __future__ import annotations

import marshal
from collections.abc import Callable, Sequence
from itertools import compress, count
from math import copysign
from operator import ne
from typing import Any, NamedTuple

from ..compat.hal_callbacks import WriteFlags


class Leaf(NamedTuple):
    """One value of the tree.

    :param path: its path
    :param read: returns the plain value
    :param handle: of a value of a SimDevice; 0 for others
    :param convert: returns the plain value from what `read` returns, where that takes long
    """

    path: str
    read: Callable[[], Any]
    handle: int = 0
    convert: Callable[[Any], Any] | None = None


def same(old: object, new: object) -> bool:
    """Return whether two values are written alike: -0.0 is not 0.0, True is not 1, and NaN is NaN."""
    if old is new:
        return True
    if type(old) is type(new) is float:  # the text of a float takes long to make
        return copysign(1, old) == copysign(1, new) if old == new else old != old and new != new
    return repr(old) == repr(new)


class ChangingValues:
    """The current values of some leaves.

    Attributes:
        values: the values at the last look
    """

    def __init__(self, leaves: Sequence[Leaf]) -> None:
        #: The positions of each value of a SimDevice, which may have several paths.
        positions: dict[int, list[int]] = {}
        for position, leaf in enumerate(leaves):
            if leaf.handle:
                positions.setdefault(leaf.handle, []).append(position)
        self._reported = [[(position, leaves[position].read) for position in each] for each in positions.values()]
        self._flags = WriteFlags(list(positions))
        self._others = [position for position, leaf in enumerate(leaves) if not leaf.handle]
        self._reads = [leaves[position].read for position in self._others]
        self._converts = [leaves[position].convert for position in self._others]
        found = [leaf.read() for leaf in leaves]
        #: What was last read of the values that are read at each look.
        self._last = [found[position] for position in self._others]
        self._packed = marshal.dumps(self._last, 2)
        self.values = [
            value if leaf.convert is None else leaf.convert(value) for leaf, value in zip(leaves, found, strict=True)
        ]

    def look(self) -> list[int]:
        """Read what may have changed; return the positions of the changed values, in order."""
        changed = self._read_written()
        others = self._read_others()
        return sorted([*changed, *others]) if changed or others else changed

    def _read_written(self) -> list[int]:
        values, reported = self.values, self._reported
        changed = []
        for number in self._flags.take():
            for position, read in reported[number]:
                old, new = values[position], read()
                if (old != new and new == new) or not same(old, new):  # NaN differs from itself
                    values[position] = new
                    changed.append(position)
        return changed

    def _read_others(self) -> list[int]:
        found, last = [read() for read in self._reads], self._last
        places = []
        for place in compress(count(), map(ne, last, found)):
            old, new = last[place], found[place]
            last[place] = new
            if (type(new) is float and new == new) or not same(old, new):  # NaN differs from itself
                places.append(place)
        # What is left may be equal and not the same, such as 0.0 and -0.0. Version 2 of the format does not depend on
        # which objects are shared.
        packed = marshal.dumps(found, 2)
        if packed != (marshal.dumps(last, 2) if places else self._packed):
            places = sorted(
                {*places, *(place for place, pair in enumerate(zip(last, found, strict=True)) if not same(*pair))}
            )
            last[:] = found
        self._packed = packed
        changed = []
        for place in places:
            position, convert, value = self._others[place], self._converts[place], found[place]
            self.values[position] = value if convert is None else convert(value)
            changed.append(position)
        return changed

    def close(self) -> None:
        """End the HAL's reports."""
        self._flags.close()
