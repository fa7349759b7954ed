"""Every changed value of every packet, kept so that any moment and any plot is there at once.

The changes are in chunks of `_PACKETS` packets. A chunk knows all values at its beginning, so the values of any moment
need one chunk. Memory is limited: beyond `MOST_BYTES`, the oldest chunks are moved to a temporary file; beyond
`MOST_STORED_BYTES` in it, former runs and the oldest chunks are forgotten.
"""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from .chunks import Chunk, ChunkFile
from .columns import MISSING, Column

#: The number of packets in a chunk, about 20 s of robot time.
_PACKETS = 1024
#: About how much memory the histories may take together, and how much space in a temporary file.
MOST_BYTES, MOST_STORED_BYTES = 64 << 20, 2 << 30


@dataclass(frozen=True)
class Piece:
    """Consecutive changes of one value.

    :param times: the times of all packets of its chunk
    :param column: the changes; `begin` is the number of the first one, and `end` of the one after the last
    """

    times: array[float]
    column: Column
    begin: int
    end: int

    def change_times(self) -> array[float]:
        """Return the time of each change."""
        packets = self.column.packets[self.begin : self.end]
        if packets[-1] - packets[0] == len(packets) - 1:  # it changed in every packet
            return self.times[packets[0] : packets[-1] + 1]
        return array("d", map(self.times.__getitem__, packets))


class History:
    """The values of one run. Use it from one thread at a time."""

    def __init__(self) -> None:
        self._chunks: list[Chunk] = []
        #: The number of packets that were forgotten.
        self._forgotten = 0
        self._now: dict[str, Any] = {}

    @property
    def now(self) -> MappingProxyType[str, Any]:
        """All values after the last change."""
        return MappingProxyType(self._now)

    @property
    def begin(self) -> float:
        """The time of the first change that is known."""
        return next((chunk.times[0] for chunk in self._chunks if chunk.times), 0.0)

    @property
    def end(self) -> float:
        """The time of the last change."""
        return next((chunk.times[-1] for chunk in reversed(self._chunks) if chunk.times), 0.0)

    @property
    def chunks(self) -> tuple[Chunk, ...]:
        """All packets, in order."""
        return tuple(self._chunks)

    @property
    def size(self) -> int:
        """About how many bytes it takes."""
        return sum(chunk.size for chunk in self._chunks)

    def add(self, time: float, values: Mapping[str, Any], gone: Iterable[str] = ()) -> None:
        """Add the changes of one packet, which is not earlier than those before."""
        chunk = self._chunks[-1] if self._chunks else self._next_chunk()
        if len(chunk.times) >= _PACKETS:
            chunk = self._next_chunk()
        packet, now = chunk.add(time, values), self._now
        now.update(values)
        for path in gone:
            chunk.add_gone(packet, path)
            now.pop(path, None)

    def _next_chunk(self) -> Chunk:
        if self._chunks:
            self._chunks[-1].close()
        self._chunks.append(Chunk(dict(self._now)))
        return self._chunks[-1]

    def forget_oldest(self) -> bool:
        """Forget the oldest chunk, and return whether there was one besides the last."""
        if len(self._chunks) < 2:
            return False
        self._forgotten += len(self._chunks.pop(0).times)
        return True

    def forget_file(self, file: ChunkFile) -> None:
        """Forget the chunks that are in a file, which are the oldest."""
        while self._chunks[0].is_in(file):
            self.forget_oldest()

    def store_oldest(self, file: ChunkFile) -> bool:
        """Move the oldest chunk that is in memory to a file, and return whether there was one besides the last.

        :raises OSError: when the disk is full
        """
        former: Chunk | None = None
        for chunk in self._chunks[:-1]:
            if not chunk.is_stored:
                chunk.store(file, former)
                return True
            former = chunk
        return False

    def until(self, time: float) -> History:
        """Return the part until a moment, which can grow differently. The two share the chunks before."""
        part = History()
        whole = bisect_right(self._chunks, time, key=lambda chunk: chunk.times[-1] if chunk.times else time)
        part._chunks = self._chunks[:whole]
        part._forgotten = self._forgotten
        if whole < len(self._chunks):
            part._chunks.append(self._chunks[whole].until(time))
        elif part._chunks:  # the last chunk grows: the two may not share it
            part._chunks[-1] = part._chunks[-1].until(time)
        part._now = dict(part.values_at(time))
        return part

    def values_at(self, time: float) -> dict[str, Any]:
        """Return all values at a moment; those at the first known moment if it is earlier."""
        number = max(self._chunk_at(time), 0)
        if number >= len(self._chunks):
            return {}
        chunk = self._chunks[number]
        packet = max(chunk.packet_at(time), 0)
        values = dict(chunk.base)
        for path, column in chunk.columns.items():
            values[path] = column.value_at(packet, values.get(path, MISSING))
        return {path: value for path, value in values.items() if value is not MISSING}

    def value_at(self, path: str, time: float) -> Any:
        """Return one value at a moment; `MISSING` if there was none."""
        number = self._chunk_at(time)
        if number < 0:
            return MISSING
        chunk = self._chunks[number]
        base = chunk.base.get(path, MISSING)
        column = chunk.columns.get(path)
        return base if column is None else column.value_at(chunk.packet_at(time), base)

    def _chunk_at(self, time: float) -> int:
        """Return the number of the last chunk that begins until a moment; -1 before the first."""
        return bisect_right(self._chunks, time, key=lambda chunk: chunk.times[0] if chunk.times else time) - 1

    def pieces(self, path: str, begin: float, end: float) -> Iterator[Piece]:
        """Yield the changes of a value after one moment, until another one."""
        for chunk in self._chunks:
            if not chunk.times or chunk.times[-1] <= begin or chunk.times[0] > end:
                continue
            column = chunk.columns.get(path)
            if column is not None:
                first, after = column.between(chunk.packet_at(begin) + 1, chunk.packet_at(end))
                if first < after:
                    yield Piece(chunk.times, column, first, after)

    def changes(self, path: str) -> int:
        """Return how often a value has changed."""
        return sum(len(chunk.columns[path]) for chunk in self._chunks if path in chunk.columns)

    # -- for readers that follow it -------------------------------------------------------------------------------

    @property
    def packets(self) -> int:
        """The number of packets so far."""
        return self._forgotten + sum(len(chunk.times) for chunk in self._chunks)

    def since(self, packet: int, path: str) -> Iterator[tuple[float, Any]]:
        """Yield a value's changes from the packet with this number on: their times, and the values."""
        after = self.packets
        found: list[list[tuple[float, Any]]] = []
        for chunk in reversed(self._chunks):
            before = after - len(chunk.times)
            if (column := chunk.columns.get(path)) is not None:
                first, end = column.between(max(packet - before, 0), len(chunk.times))
                found.append([(chunk.times[column.packets[each]], column.value(each)) for each in range(first, end)])
            after = before
            if before <= packet:
                break
        for part in reversed(found):
            yield from part
