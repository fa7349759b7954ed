"""Reads many values of the HAL, in a time that depends on how many of them are written.

A value of a SimDevice is read only after the HAL has reported a write, which takes less time than a read. Those that
are written in most packets are read in all, so that their reports need not be found and cleared.

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

#: How many looks decide which values of SimDevices are written often, and for how many looks this holds: a second.
_CHOOSING_LOOKS, _LOOKS_BETWEEN = 3, 50


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
        self._leaves = leaves
        self._reported = list(positions.values())
        self._flags = WriteFlags(list(positions))
        found = [leaf.read() for leaf in leaves]
        self._others = _Polled([(at, leaf, found[at]) for at, leaf in enumerate(leaves) if not leaf.handle])
        #: The values that are often written, and how many more looks these are. They are chosen again now and then, so
        #: that values which are no longer written take no time.
        self._often = _Polled([])
        self._looks_left = 0
        #: What was written in the looks in which they are chosen, and how many of these looks follow.
        self._chosen: set[int] = set()
        self._choosing = _CHOOSING_LOOKS
        self.values = [
            value if leaf.convert is None else leaf.convert(value) for leaf, value in zip(leaves, found, strict=True)
        ]

    def look(self) -> list[int]:
        """Read what may have changed; return the positions of the changed values, in order."""
        changed = self._read_written()
        changed += self._others.read(self.values)
        changed.sort()
        return changed

    def _read_written(self) -> list[int]:
        looks_left, flags, changed = self._looks_left, self._flags, []
        if looks_left:
            self._looks_left -= 1
            if looks_left == 1:
                flags.keep(())
        written = flags.take()
        if looks_left:
            changed = self._often.read(self.values)
        if written:
            values, leaves, reported = self.values, self._leaves, self._reported
            for number in written:
                for position in reported[number]:
                    old, new = values[position], leaves[position].read()
                    if (old != new and new == new) or not same(old, new):  # NaN differs from itself
                        values[position] = new
                        changed.append(position)
            if not looks_left:
                self._choose(written)
        return changed

    def _choose(self, written: list[int]) -> None:
        """Choose which values are read at each of the next looks, after some looks with values that were written."""
        self._chosen.update(written)
        self._choosing -= 1
        if not self._choosing:
            often = sorted(position for number in self._chosen for position in self._reported[number])
            self._often = _Polled([(at, self._leaves[at], self.values[at]) for at in often])
            self._flags.keep(self._chosen)
            self._chosen, self._choosing, self._looks_left = set(), _CHOOSING_LOOKS, _LOOKS_BETWEEN

    def close(self) -> None:
        """End the HAL's reports."""
        self._flags.close()


class _Polled:
    """Values that are read at each look.

    :param leaves: the position, the leaf, and what it was last read as
    """

    def __init__(self, leaves: Sequence[tuple[int, Leaf, Any]]) -> None:
        self._positions = [position for position, _, _ in leaves]
        self._reads = [leaf.read for _, leaf, _ in leaves]
        self._converts = [leaf.convert for _, leaf, _ in leaves]
        self._last = [value for _, _, value in leaves]
        self._packed = marshal.dumps(self._last, 2)

    def read(self, values: list[Any]) -> list[int]:
        """Update `values`; return the positions of those that have changed."""
        found, last, positions, converts = [read() for read in self._reads], self._last, self._positions, self._converts
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
            places += [place for place, pair in enumerate(zip(last, found, strict=True)) if not same(*pair)]
            self._last = found
        self._packed = packed
        for place in places:
            convert, new = converts[place], found[place]
            values[positions[place]] = new if convert is None else convert(new)
        return [positions[place] for place in places]
