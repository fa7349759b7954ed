"""Reads many values of the HAL, in a time that depends on how many of them are written.

A value is read only after the HAL has reported a write, which takes less time than a read. Those that are written in
most packets are read in all, so that their reports need not be found and cleared. Values that may change without a
report are read at each look: there are few.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from math import copysign
from typing import Any, NamedTuple

from ..compat.hal_callbacks import Report, WriteFlags, resets
from ..compat.hal_memory import ManyNumbers, NumberMemory, value_memory

#: How many looks decide which values are written often, and for how many looks this holds: five seconds.
_CHOOSING_LOOKS, _LOOKS_BETWEEN = 3, 250


_SCALARS = frozenset((float, int, bool, str, bytes))


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


def same(old: Any, new: Any) -> bool:
    """Return whether two values are written alike: -0.0 is not 0.0, True is not 1, and NaN is NaN."""
    if old is new:
        return True
    kind = type(old)
    if kind is type(new) and kind in _SCALARS:  # texts take long to make
        if kind is not float:
            return bool(old == new)
        return copysign(1, old) == copysign(1, new) if old == new else old != old and new != new
    return repr(old) == repr(new)


def are_reported(reports: Sequence[Report]) -> bool:
    """Return whether each change will be reported, until a reset that is announced."""
    return bool(reports) and all(report.of_sim_device or (resets.announced and report.exists) for report in reports)


class ChangingValues:
    """The current values of some leaves, in a list that the caller keeps.

    :param devices: the handles of the SimDevices

    Attributes:
        values: the values when this is created, in order
    """

    def __init__(self, leaves: Sequence[Leaf], devices: Sequence[int] = ()) -> None:
        #: The positions of each reported value, which may have several paths.
        positions: dict[tuple[Report, ...], list[int]] = {}
        unreported = []
        for position, leaf in enumerate(leaves):
            if are_reported(leaf.reports):
                positions.setdefault(leaf.reports, []).append(position)
            else:
                unreported.append(position)
        self._leaves, self._devices = leaves, devices
        self._reported = list(positions.values())
        self._flags = WriteFlags(list(positions))
        #: What each leaf was last read as.
        self._found = [leaf.read() for leaf in leaves]
        self._unreported = unreported
        #: The values that are often written, and how many more looks these are. They are chosen again now and then, so
        #: that values which are no longer written take no time.
        self._often = _OftenWritten((), leaves, self._found, {})
        self._looks_left = 0
        #: What was written in the looks in which they are chosen, and how many of these looks follow.
        self._chosen: set[int] = set()
        self._choosing = _CHOOSING_LOOKS
        self.values = [
            found if leaf.convert is None else leaf.convert(found)
            for leaf, found in zip(leaves, self._found, strict=True)
        ]

    def look(self, values: list[Any]) -> list[int]:
        """Read what may have changed into `values`; return the positions of the changed values, in order."""
        changed = self._read_written(values)
        changed += _read(self._unreported, self._leaves, self._found, values)
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
            changed = self._often.read_all(values)
        if written:
            positions = [position for number in written for position in self._reported[number]]
            changed += _read(positions, self._leaves, self._found, values)
            if not looks_left:
                self._choose(written)
        return changed

    def _choose(self, written: list[int]) -> None:
        """Choose which values are read at each of the next looks, after some looks with values that were written."""
        self._chosen.update(written)
        self._choosing -= 1
        if not self._choosing:
            often = sorted(at for number in self._chosen for at in self._reported[number])
            self._often = _OftenWritten(often, self._leaves, self._found, self._memory)
            self._flags.keep(self._chosen)
            self._chosen, self._choosing, self._looks_left = set(), _CHOOSING_LOOKS, _LOOKS_BETWEEN

    @cached_property
    def _memory(self) -> dict[tuple[Report, ...], NumberMemory]:
        """Where the HAL keeps values of SimDevices."""
        return {
            (Report("SimValueChanged", (value,)),): memory
            for device in self._devices
            for value, memory in value_memory(device).items()
        }

    def close(self) -> None:
        """End the HAL's reports."""
        self._flags.close()


def _read(positions: Iterable[int], leaves: Sequence[Leaf], found: list[Any], values: list[Any]) -> list[int]:
    """Read values; return the positions of those that have changed."""
    changed = []
    for position in positions:
        leaf, old = leaves[position], found[position]
        new = leaf.read()
        if old == new:
            if (new and type(new) in _SCALARS) or same(old, new):  # 0.0 and -0.0 are equal, and not the same
                continue
        elif new != new and same(old, new):  # NaN differs from itself
            continue
        found[position] = new
        values[position] = new if leaf.convert is None else leaf.convert(new)
        changed.append(position)
    return changed


class _OftenWritten:
    """Values that are read at each look.

    :param positions: their positions among all values
    :param leaves: all leaves
    :param found: what all values were last read as
    :param memory: where the HAL keeps the values of these reports
    """

    def __init__(
        self,
        positions: Iterable[int],
        leaves: Sequence[Leaf],
        found: list[Any],
        memory: Mapping[tuple[Report, ...], NumberMemory],
    ) -> None:
        self._leaves, self._found = leaves, found
        #: The positions of numbers whose memory is known, by format, and of all others.
        numbers: dict[str, list[int]] = {}
        self._others: list[int] = []
        for position in positions:
            leaf = leaves[position]
            place = memory.get(leaf.reports)
            # What is at this address has to be what the HAL returns.
            if place is not None and same(place.read(), leaf.read()):
                numbers.setdefault(place.format, []).append(position)
            else:
                self._others.append(position)
        self._numbers = [
            ManyNumbers([memory[leaves[at].reports] for at in some], some, [found[at] for at in some])
            for some in numbers.values()
        ]

    def read_all(self, values: list[Any]) -> list[int]:
        """Update `values`; return the positions of those that have changed."""
        found = self._found
        changed = _read(self._others, self._leaves, found, values)
        for numbers in self._numbers:
            changed += numbers.update(found, values)
        return changed
