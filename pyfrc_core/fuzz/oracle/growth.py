"""Find what grows all the time in a match: lists and the like in the robot's objects, and entries of NetworkTables.

The number of elements is the same in each run of a match. The memory of the process is not: it depends on Python's
allocator, on libraries, and on pyfrc itself.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

from ...wpi import network

CONTAINERS = (list, dict, set, deque, bytearray)

#: Returns the attributes that have elements, by path: their owner's attributes, and their name.
Containers = Callable[[], dict[str, tuple[dict[str, object], str]]]

NETWORK_TABLES = "NetworkTables"

#: The interval of counts, in microseconds.
_EVERY_US = 4_000_000
#: What grows is larger at each count by at least this much, for this many counts: perhaps only after some input.
_LEAST_MORE, _LEAST_COUNTS = 20, 6


class Growth(NamedTuple):
    """What grew all the time.

    :param name: the path of the attribute, from the robot
    :param per_second: by how many elements a second
    :param size: the number of elements at the end
    """

    name: str
    per_second: float
    size: int


class Growths:
    """Counts elements during one match."""

    def __init__(self, containers: Containers) -> None:
        self._containers = containers
        self._counts: dict[str, list[int]] = {}
        #: When it is time for the next count.
        self.next_us = _EVERY_US

    def after_packet(self, now_us: int) -> None:
        """Count when it is time."""
        if now_us < self.next_us:
            return
        self.next_us = now_us + _EVERY_US
        self._count(NETWORK_TABLES, network.count_entries())
        for path, (owner, name) in self._containers().items():
            thing = owner.get(name)
            if isinstance(thing, CONTAINERS) and getattr(thing, "maxlen", None) is None:
                self._count(path, len(thing))

    def _count(self, name: str, size: int) -> None:
        self._counts.setdefault(name, []).append(size)

    def found(self) -> Iterator[Growth]:
        """Yield what grew from each count to the next at the end of the match, by its path."""
        for name, every in sorted(self._counts.items()):
            counts = every[-_LEAST_COUNTS:]
            more = [after - before for before, after in pairwise(counts)]
            if len(counts) >= _LEAST_COUNTS and min(more) >= _LEAST_MORE:
                yield Growth(name, sum(more) / len(more) * 1_000_000 / _EVERY_US, counts[-1])
