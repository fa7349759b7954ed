"""Reads many values of the HAL, in a time that depends on how many of them are written.

A value is read only after the HAL has reported a write, which takes less time than a read. Those that are written in
most packets are read in all, so that their reports need not be found and cleared. Values that may change without a
report are read at each look: there are few.
"""

from __future__ import annotations

import marshal
from collections.abc import Callable, Sequence
from itertools import compress, count
from math import copysign
from operator import ne
from typing import Any, NamedTuple

from ..compat.hal_callbacks import Report, WriteFlags, resets

#: How many looks decide which values are written often, and for how many looks this holds: a second.
_CHOOSING_LOOKS, _LOOKS_BETWEEN = 3, 50


class Leaf(NamedTuple):
    """One value of the tree.

    :param path: its path
    :param read: returns the plain value
    :param reports: as in `Slot`
    :param convert: returns the plain value from what `read` returns, where that takes long
    """

    path: str
    read: Callable[[], Any]
    reports: tuple[Report, ...] = ()
    convert: Callable[[Any], Any] | None = None


def same(old: object, new: object) -> bool:
    """Return whether two values are written alike: -0.0 is not 0.0, True is not 1, and NaN is NaN."""
    if old is new:
        return True
    if type(old) is type(new) is float:  # the text of a float takes long to make
        return copysign(1, old) == copysign(1, new) if old == new else old != old and new != new
    return repr(old) == repr(new)


def are_reported(reports: Sequence[Report]) -> bool:
    """Return whether each change will be reported, until a reset that is announced."""
    return bool(reports) and all(report.of_sim_device or (resets.announced and report.exists) for report in reports)


class ChangingValues:
    """The current values of some leaves, in a list that the caller keeps.

    Attributes:
        values: the values when this is created, in order
    """

    def __init__(self, leaves: Sequence[Leaf]) -> None:
        #: The positions of each reported value, which may have several paths.
        positions: dict[tuple[Report, ...], list[int]] = {}
        unreported = []
        for position, leaf in enumerate(leaves):
            if are_reported(leaf.reports):
                positions.setdefault(leaf.reports, []).append(position)
            else:
                unreported.append(position)
        self._leaves = leaves
        self._reported = list(positions.values())
        self._flags = WriteFlags(list(positions))
        #: What each leaf was last read as.
        self._found = [leaf.read() for leaf in leaves]
        self._unreported = self._polled(unreported)
        #: The values that are often written, and how many more looks these are. They are chosen again now and then, so
        #: that values which are no longer written take no time.
        self._often = self._polled([])
        self._looks_left = 0
        #: What was written in the looks in which they are chosen, and how many of these looks follow.
        self._chosen: set[int] = set()
        self._choosing = _CHOOSING_LOOKS
        self.values = [_converted(leaf, found) for leaf, found in zip(leaves, self._found, strict=True)]

    def look(self, values: list[Any]) -> list[int]:
        """Read what may have changed into `values`; return the positions of the changed values, in order."""
        changed = self._read_written(values)
        changed += self._unreported.read(values)
        changed.sort()
        return changed

    def _read_written(self, values: list[Any]) -> list[int]:
        looks_left, flags, changed = self._looks_left, self._flags, []
        if looks_left:
            self._looks_left -= 1
            if looks_left == 1:
                flags.keep(())
        written = flags.take()
        if looks_left:
            changed = self._often.read(values)
        if written:
            leaves, found, reported = self._leaves, self._found, self._reported
            for number in written:
                for position in reported[number]:
                    leaf = leaves[position]
                    old, new = found[position], leaf.read()
                    if (old != new and new == new) or not same(old, new):  # NaN differs from itself
                        found[position] = new
                        values[position] = _converted(leaf, new)
                        changed.append(position)
            if not looks_left:
                self._choose(written)
        return changed

    def _choose(self, written: list[int]) -> None:
        """Choose which values are read at each of the next looks, after some looks with values that were written."""
        self._chosen.update(written)
        self._choosing -= 1
        if not self._choosing:
            self._often = self._polled(sorted(at for number in self._chosen for at in self._reported[number]))
            self._flags.keep(self._chosen)
            self._chosen, self._choosing, self._looks_left = set(), _CHOOSING_LOOKS, _LOOKS_BETWEEN

    def _polled(self, positions: Sequence[int]) -> _Polled:
        return _Polled(positions, [self._leaves[position] for position in positions], self._found)

    def close(self) -> None:
        """End the HAL's reports."""
        self._flags.close()


def _converted(leaf: Leaf, found: Any) -> Any:
    return found if leaf.convert is None else leaf.convert(found)


class _Polled:
    """Values that are read at each look.

    :param positions: their positions among all values
    :param found: what all values were last read as
    """

    def __init__(self, positions: Sequence[int], leaves: Sequence[Leaf], found: list[Any]) -> None:
        self._positions, self._leaves, self._found = positions, leaves, found
        self._reads = [leaf.read for leaf in leaves]
        self._last = [found[position] for position in positions]
        self._packed = marshal.dumps(self._last, 2)

    def read(self, values: list[Any]) -> list[int]:
        """Update `values`; return the positions of those that have changed."""
        last, now = self._last, [read() for read in self._reads]
        places = []
        for place in compress(count(), map(ne, last, now)):
            old, new = last[place], now[place]
            last[place] = new
            if (type(new) is float and new == new) or not same(old, new):  # NaN differs from itself
                places.append(place)
        # What is left may be equal and not the same, such as 0.0 and -0.0. Version 2 of the format does not depend on
        # which objects are shared.
        packed = marshal.dumps(now, 2)
        if packed != (marshal.dumps(last, 2) if places else self._packed):
            places += [place for place, pair in enumerate(zip(last, now, strict=True)) if not same(*pair)]
            self._last = now
        self._packed = packed
        changed = []
        for place in places:
            position, new = self._positions[place], now[place]
            self._found[position] = new
            values[position] = _converted(self._leaves[place], new)
            changed.append(position)
        return changed
