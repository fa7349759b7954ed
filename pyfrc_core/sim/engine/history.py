"""What has happened, in order of time. All but its end is on disk, so that memory does not grow in a long run."""

from __future__ import annotations

import os
import pickle
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
from operator import itemgetter
from tempfile import TemporaryFile
from typing import Generic, TypeVar

Item = TypeVar("Item")

#: The number of entries that are written at once. At least as many are in memory, and fewer than twice as many.
_BLOCK = 512


class _File:
    """A temporary file without a name, closed when no history needs it any more."""

    def __init__(self) -> None:
        self.io = TemporaryFile(prefix="pyfrc-sim-", buffering=0)  # noqa: SIM115

    def __del__(self) -> None:
        if hasattr(self, "io"):  # otherwise there was no space for it
            self.io.close()


@dataclass(frozen=True)
class _Block:
    """Entries in a file, pickled; never changed, so that several histories may share it.

    :param last_us: the time of its last entry
    :param count: the number of its entries
    """

    file: _File
    offset: int
    last_us: int
    count: int


class History(Generic[Item]):
    """A growing list of entries with their times, in microseconds.

    Its temporary file has no name and disappears with the process. Use a history from one thread at a time.
    """

    def __init__(self) -> None:
        self._blocks: list[_Block] = []
        #: The number of entries in the blocks.
        self._written = 0
        self._recent: list[tuple[int, Item]] = []
        self._file: _File | None = None
        self._most = 2 * _BLOCK

    def append(self, at_us: int, item: Item) -> None:
        """Add an entry. Its time is not earlier than that of the entry before."""
        self._recent.append((at_us, item))
        if len(self._recent) >= self._most:
            self._write()

    def _write(self) -> None:
        entries = self._recent[:-_BLOCK]
        try:
            if self._file is None:
                self._file = _File()
            offset = self._file.io.seek(0, os.SEEK_END)
            data = memoryview(pickle.dumps(entries, pickle.HIGHEST_PROTOCOL))
            while data:
                data = data[self._file.io.write(data) :]
        except OSError:  # the disk is full: the entries stay in memory until more have come
            self._most *= 2
            return
        self._blocks.append(_Block(self._file, offset, entries[-1][0], len(entries)))
        self._written += len(entries)
        del self._recent[:-_BLOCK]
        self._most = 2 * _BLOCK

    def __len__(self) -> int:
        return self._written + len(self._recent)

    def __iter__(self) -> Iterator[tuple[int, Item]]:
        return self.since(0)

    def since(self, number: int) -> Iterator[tuple[int, Item]]:
        """Yield the entries from the one with this number on; they count from 0."""
        before = 0
        if number < self._written:  # not for readers that follow: they take no longer in a long run
            for block in self._blocks:
                if number < before + block.count:
                    yield from self._read(block)[max(number - before, 0) :]
                before += block.count
        yield from self._recent[max(number - self._written, 0) :]

    @property
    def last(self) -> Item | None:
        """The last entry."""
        return self._recent[-1][1] if self._recent else None

    def until(self, time_us: int) -> History[Item]:
        """Return the part until a moment. It can grow differently from this one."""
        part = History[Item]()
        whole = bisect_right(self._blocks, time_us, key=lambda block: block.last_us)
        part._blocks = self._blocks[:whole]
        after = self._read(self._blocks[whole]) if whole < len(self._blocks) else self._recent
        part._recent = list(takewhile(lambda entry: entry[0] <= time_us, after))
        if not part._recent and part._blocks:
            part._recent = self._read(part._blocks.pop())
        part._written = sum(block.count for block in part._blocks)
        return part

    @staticmethod
    def _read(block: _Block) -> list[tuple[int, Item]]:
        block.file.io.seek(block.offset)
        return pickle.load(block.file.io)  # type: ignore[no-any-return]


def entries(history: History[Item]) -> Iterator[Item]:
    """Iterate over the entries, without their times."""
    return map(itemgetter(1), history)
