"""Find what only grows in a match: lists and the like in the robot's objects, and entries of NetworkTables.

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
_EVERY_US = 2_000_000
#: What only grows has become larger by at least this much, at so many counts since it last became smaller.
_LEAST_MORE, _LEAST_TIMES = 10, 8
#: It has done so at one of the last counts: else it is full.
_LAST = 2


class Growth(NamedTuple):
    """What only grew.

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
        """Yield what only grew until the end of the match, by its path; it may have waited for some input."""
        for name, counts in sorted(self._counts.items()):
            more: list[int] = []
            for before, after in pairwise(counts):
                more = [*more, after - before] if after >= before else []
            if sum(each >= _LEAST_MORE for each in more) >= _LEAST_TIMES and max(more[-_LAST:]) >= _LEAST_MORE:
                yield Growth(name, sum(more) / len(more) * 1_000_000 / _EVERY_US, counts[-1])
