"""Consecutive packets of a history: in memory while they are new, and in a temporary file when there are many."""

from __future__ import annotations

import io
import os
import pickle
from array import array
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from tempfile import TemporaryFile
from types import MappingProxyType
from typing import Any

from .columns import MISSING, Column

#: About the size of a value in the list of those at a chunk's beginning, in bytes.
_BASE_SIZE = 130


class _Pickler(pickle.Pickler):
    """Also pickles the unchangeable dicts that structs are."""

    def reducer_override(self, item: Any) -> Any:
        return (_unchangeable, (dict(item),)) if isinstance(item, MappingProxyType) else NotImplemented


def _unchangeable(values: dict[str, Any]) -> Mapping[str, Any]:
    return MappingProxyType(values)  # a type without a name that pickle could find


class ChunkFile:
    """A temporary file without a name. It disappears with the process, and when no chunk needs it any more."""

    def __init__(self) -> None:
        self._io = TemporaryFile(prefix="pyfrc-sim-", buffering=0)  # noqa: SIM115
        #: The number of bytes in it.
        self.size = 0

    def append(self, item: object) -> int:
        """Add an object, and return its place.

        :raises OSError: when the disk is full
        """
        place = self._io.seek(0, os.SEEK_END)
        pickled = io.BytesIO()
        _Pickler(pickled, pickle.HIGHEST_PROTOCOL).dump(item)
        data = pickled.getbuffer()
        while data:
            data = data[self._io.write(data) :]
        self.size = self._io.tell()
        return place

    def read(self, place: int) -> Any:
        """Return the object at a place."""
        self._io.seek(place)
        return pickle.load(self._io)

    def __del__(self) -> None:
        if hasattr(self, "_io"):  # otherwise there was no space for it
            self._io.close()


class _StoredColumns(Mapping[str, Column]):
    """Columns in a file.

    :param numbers: the number of each path among the places; chunks with the same paths share it
    """

    def __init__(self, file: ChunkFile, numbers: Mapping[str, int], places: array[int]) -> None:
        self.numbers = numbers
        self._file, self._places = file, places

    def __getitem__(self, path: str) -> Column:
        return self._file.read(self._places[self.numbers[path]])  # type: ignore[no-any-return]

    def __iter__(self) -> Iterator[str]:
        return iter(self.numbers)

    def __len__(self) -> int:
        return len(self.numbers)


class Chunk:
    """Consecutive packets.

    :param base: all values before its first packet
    """

    def __init__(self, base: Mapping[str, Any]) -> None:
        self.times = array("d")
        self.columns: Mapping[str, Column] = {}
        self._base: Mapping[str, Any] | None = base
        self._file: ChunkFile | None = None
        self._base_place = 0
        self._closed_size: int | None = None

    @property
    def base(self) -> Mapping[str, Any]:
        """All values before its first packet."""
        if self._base is None:
            assert self._file is not None
            return self._file.read(self._base_place)  # type: ignore[no-any-return]
        return self._base

    @property
    def is_stored(self) -> bool:
        """Whether it is in a file."""
        return self._file is not None

    def is_in(self, file: ChunkFile) -> bool:
        """Return whether it is in this file."""
        return self._file is file

    @property
    def size(self) -> int:
        """About how many bytes of memory it takes."""
        if self._closed_size is not None:
            return self._closed_size
        columns = sum(column.size for column in self.columns.values())
        return 8 * len(self.times) + _BASE_SIZE * len(self.base) + columns

    def add(self, time: float, values: Mapping[str, Any]) -> int:
        """Add the changes of a packet, and return its number."""
        packet = len(self.times)
        self.times.append(time)
        columns = self.columns
        assert isinstance(columns, dict)
        for path, value in values.items():
            column = columns.get(path)
            if column is None:
                column = columns[path] = Column(value)
            column.append(packet, value)
        return packet

    def add_gone(self, packet: int, path: str) -> None:
        """Note that a value no longer exists after a packet."""
        assert isinstance(self.columns, dict)
        self.columns.setdefault(path, Column(MISSING)).append(packet, MISSING)

    def close(self) -> None:
        """Note that it will not change any more."""
        self._closed_size = self.size

    def store(self, file: ChunkFile, former: Chunk | None) -> None:
        """Move a closed chunk to a file.

        :param former: a chunk in a file, which may have the same paths
        :raises OSError: when the disk is full; the chunk stays in memory
        """
        numbers: Mapping[str, int] = {path: number for number, path in enumerate(self.columns)}
        if former is not None and isinstance(former.columns, _StoredColumns) and former.columns.numbers == numbers:
            numbers = former.columns.numbers
        base = file.append(dict(self.base))
        places = array("Q", [file.append(self.columns[path]) for path in numbers])
        self.columns = _StoredColumns(file, numbers, places)
        self._base, self._base_place, self._file = None, base, file
        self._closed_size = 8 * len(self.times) + 8 * len(places) + 500

    def packet_at(self, time: float) -> int:
        """Return the number of the last packet until a moment; -1 before the first."""
        return bisect_right(self.times, time) - 1

    def until(self, time: float) -> Chunk:
        """Return a copy of the part until a moment, which can grow."""
        part, last = Chunk(self.base), self.packet_at(time)
        if last < 0:
            return part
        part.times = self.times[: last + 1]
        kept = ((path, column.until(last)) for path, column in self.columns.items())
        part.columns = {path: column for path, column in kept if column is not None}
        return part
