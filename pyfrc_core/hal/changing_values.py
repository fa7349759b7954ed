"""Reads many values of the HAL, in a time that depends on how many of them change.

A value of a SimDevice that has not changed for some looks is *quiet*: it is not read again until the HAL has reported a
write. A value that was written is read at each look until it is quiet again, since a report costs more than a read. So
a value that a vendor's library writes all the time costs one read for each look, and a constant costs nothing.

The other devices' values are read at each look. Their number is limited by the roboRIO, and their callbacks are lost
without a sign when code resets their data.
"""

from __future__ import annotations

import marshal
from collections.abc import Callable, Iterable, Sequence
from itertools import compress, count
from math import copysign
from operator import ne
from typing import Any, NamedTuple

from ..compat.hal_callbacks import HalNotes, Registered, cancel

#: Looks between two searches for values that have become quiet.
_ROUND = 25


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
        self._leaves = leaves
        self._notes: HalNotes | None = None
        #: The positions of each value of a SimDevice, which may have several paths. The HAL has one note for all.
        self._positions: dict[int, list[int]] = {}
        for position, leaf in enumerate(leaves):
            if leaf.handle:
                self._positions.setdefault(leaf.handle, []).append(position)
        #: The handles of the quiet values, and what cancels the reports of each.
        self._quiet: dict[int, Registered] = {}
        self._busy: list[int] = []
        self._changed: set[int] = set()
        self._looks = 0
        found = [leaf.read() for leaf in leaves]
        #: What was read of each leaf the last time that it was read; and of the busy ones, in their order.
        self._found: list[Any] = found
        self._last: list[Any] = []
        self._packed = b""
        self.values = [_plain(leaf, value) for leaf, value in zip(leaves, found, strict=True)]
        self._read_these(range(len(leaves)))

    def look(self) -> list[int]:
        """Read what may have changed; return the positions of the changed values, in order."""
        if self._notes:
            self._wake(set(self._notes.take()))
        self._looks += 1
        # The values that become quiet are read once more, because they may be written before the HAL reports it.
        quiet = self._find_quiet() if self._looks % _ROUND == 0 else False
        changed = self._compare([read() for read in self._reads])
        if quiet:
            self._read_these(position for position in self._busy if self._leaves[position].handle not in self._quiet)
        return changed

    def _compare(self, found: list[object]) -> list[int]:
        last = self._last
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
            position = self._busy[place]
            leaf, value = self._leaves[position], found[place]
            self._found[position] = value
            self.values[position] = value if leaf.convert is None else leaf.convert(value)
            changed.append(position)
        self._changed.update(changed)
        return changed

    def _find_quiet(self) -> bool:
        handles = {self._leaves[position].handle for position in self._busy}
        quiet = handles - {self._leaves[position].handle for position in self._changed} - {0}
        self._changed.clear()
        if quiet and self._notes is None:
            self._notes = HalNotes()
        for handle in quiet:
            assert self._notes is not None
            self._quiet[handle] = self._notes.note_writes(handle, handle)
        return bool(quiet)

    def _wake(self, handles: set[int]) -> None:
        for handle in handles:
            cancel(self._quiet.pop(handle))
        written = [position for handle in handles for position in self._positions[handle]]
        self._changed.update(written)
        self._read_these([*self._busy, *written])

    def _read_these(self, positions: Iterable[int]) -> None:
        self._busy = sorted(positions)
        self._reads = [self._leaves[position].read for position in self._busy]
        self._last = [self._found[position] for position in self._busy]
        self._packed = marshal.dumps(self._last, 2)

    def close(self) -> None:
        """End the HAL's reports."""
        while self._quiet:
            cancel(self._quiet.popitem()[1])


def _plain(leaf: Leaf, value: object) -> Any:
    return value if leaf.convert is None else leaf.convert(value)
