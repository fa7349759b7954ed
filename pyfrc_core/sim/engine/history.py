"""What has happened, in order of time. All but its end is compressed, since a run may go on for hours."""

from __future__ import annotations

import pickle
import zlib
from bisect import bisect_right
from collections.abc import Iterator
from itertools import takewhile
from operator import itemgetter
from typing import Generic, NamedTuple, TypeVar

Item = TypeVar("Item")

#: The number of entries that are compressed at once. At least as many are not, and fewer than twice as many.
_BLOCK = 512


class _Block(NamedTuple):
    """Compressed entries; several histories may share them.

    :param last_us: the time of its last entry
    :param length: the number of its entries
    """

    data: bytes
    last_us: int
    length: int


class History(Generic[Item]):
    """A growing list of entries with their times, in microseconds. Use it from one thread at a time."""

    def __init__(self) -> None:
        self._blocks: list[_Block] = []
        #: The number of entries in the blocks.
        self._compressed = 0
        self._recent: list[tuple[int, Item]] = []

    def append(self, at_us: int, item: Item) -> None:
        """Add an entry. Its time is not earlier than that of the entry before."""
        self._recent.append((at_us, item))
        if len(self._recent) >= 2 * _BLOCK:
            entries = self._recent[:_BLOCK]
            del self._recent[:_BLOCK]
            self._blocks.append(_Block(zlib.compress(pickle.dumps(entries), 1), entries[-1][0], len(entries)))
            self._compressed += len(entries)

    def __len__(self) -> int:
        return self._compressed + len(self._recent)

    def __iter__(self) -> Iterator[tuple[int, Item]]:
        return self.since(0)

    def since(self, number: int) -> Iterator[tuple[int, Item]]:
        """Yield the entries from the one with this number on; they count from 0."""
        before = 0
        if number < self._compressed:  # not for readers that follow: they take no longer in a long run
            for block in self._blocks:
                if number < before + block.length:
                    yield from _entries_of(block)[max(number - before, 0) :]
                before += block.length
        yield from self._recent[max(number - self._compressed, 0) :]

    @property
    def last(self) -> Item | None:
        """The last entry."""
        return self._recent[-1][1] if self._recent else None

    def until(self, time_us: int) -> History[Item]:
        """Return the part until a moment. It can grow differently from this one."""
        part = History[Item]()
        whole = bisect_right(self._blocks, time_us, key=lambda block: block.last_us)
        part._blocks = self._blocks[:whole]
        after = _entries_of(self._blocks[whole]) if whole < len(self._blocks) else self._recent
        part._recent = list(takewhile(lambda entry: entry[0] <= time_us, after))
        if not part._recent and part._blocks:
            part._recent = _entries_of(part._blocks.pop())
        part._compressed = sum(block.length for block in part._blocks)
        return part


def _entries_of(block: _Block) -> list[tuple[int, Item]]:
    return pickle.loads(zlib.decompress(block.data))  # type: ignore[no-any-return]


def entries(history: History[Item]) -> Iterator[Item]:
    """Iterate over the entries, without their times."""
    return map(itemgetter(1), history)
