"""The inputs of a running match, kept where they survive the end of its process.

They are in memory that is mapped to a file, as in a crash log: each step is kept at once, without a call of the system.
"""

from __future__ import annotations

import io
import marshal
import mmap
import struct
from collections.abc import Iterator
from pathlib import Path

from ...runtime.scripts.script import Step

#: The journal begins with the position of its end.
_END = struct.Struct("=q")
#: By how many bytes the file grows: enough for nearly all matches.
_PART = 64 * 1024


class Journal:
    """Writes the steps of a match to a file, which may have those of the parts before.

    :param file: is created if it does not exist
    """

    def __init__(self, file: Path) -> None:
        self._file = file.open("r+b" if file.exists() else "w+b", 0)
        self._size = self._file.seek(0, io.SEEK_END)
        self._map: mmap.mmap | None = None
        self._end = _END.size
        if self._size:
            self._end = _END.unpack_from(self._grow(0))[0]

    def close(self) -> None:
        """Close the file."""
        if self._map is not None:
            self._map.close()
        self._file.close()

    def add(self, step: Step) -> None:
        """Write a step, which is then safe."""
        # Only plain values are written, and in this version of Python they are read again.
        data = marshal.dumps((step.at_us, dict(step.writes)))
        begin, end = self._end, self._end + len(data)
        written = self._map
        if written is None or end > self._size:
            written = self._grow(end - self._size)
        written[begin:end] = data
        _END.pack_into(written, 0, end)  # last, so that no step is read that is not whole
        self._end = end

    def _grow(self, by: int) -> mmap.mmap:
        """Map the file to memory, longer by at least this many bytes."""
        if self._map is not None:
            self._map.close()
        if by > 0:
            self._size += max(by, _PART)
            self._file.truncate(self._size)
        self._map = mmap.mmap(self._file.fileno(), self._size)
        return self._map


def read_journal(file: Path) -> Iterator[Step]:
    """Return the steps in a journal; none if there is no file."""
    data = file.read_bytes() if file.is_file() else b""
    if len(data) < _END.size:
        return
    steps = io.BytesIO(data[: _END.unpack_from(data)[0]])
    steps.seek(_END.size)
    while steps.tell() < len(steps.getbuffer()):
        at_us, writes = marshal.load(steps)
        yield Step(at_us, writes)
