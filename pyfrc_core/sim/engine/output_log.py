"""What robots have printed, for several readers: each reads all of it, at its own pace.

The text is kept in temporary files, so that it is still there for a reader that is late, and memory does not grow. A
robot that prints without end must not fill the disk: beyond `_MOST_SEGMENTS` files, the oldest text is dropped.
"""

from __future__ import annotations

import threading
from codecs import getincrementaldecoder
from collections import deque
from tempfile import SpooledTemporaryFile

#: The size of one file, in bytes, and how many of them are kept.
_SEGMENT, _MOST_SEGMENTS = 8 << 20, 16
#: What stays in memory of a file: most robots print less.
_IN_MEMORY = 1 << 16
#: How much a reader takes from a file at once, in bytes.
_PIECE = 1 << 16


class _Segment:
    """Consecutive text in one file.

    :param start: the number of bytes before it
    """

    def __init__(self, start: int) -> None:
        self.start = self.end = start
        self._file = SpooledTemporaryFile(max_size=_IN_MEMORY, prefix="pyfrc-sim-")  # noqa: SIM115

    def append(self, data: bytes) -> None:
        self._file.seek(self.end - self.start)
        self._file.write(data)
        self._file.flush()
        self.end += len(data)

    def read(self, at: int) -> bytes:
        self._file.seek(at - self.start)
        return self._file.read(min(_PIECE, self.end - at))

    def __del__(self) -> None:
        if hasattr(self, "_file"):  # else there was no room for it
            self._file.close()


class OutputLog:
    """A text that grows at its end. May be used from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._segments: deque[_Segment] = deque()
        self._end = 0

    def append(self, text: str) -> None:
        """Add a text at the end."""
        data = text.encode("utf-8", "surrogatepass")
        with self._lock:
            try:
                if not self._segments or self._segments[-1].end != self._end or self._is_full(self._segments[-1]):
                    self._segments.append(_Segment(self._end))
                self._segments[-1].append(data)
            except OSError:  # the disk is full: readers are shown a gap
                pass
            self._end += len(data)
            while len(self._segments) > _MOST_SEGMENTS:
                self._segments.popleft()

    def cursor(self, from_start: bool = True) -> OutputCursor:
        """Return a reader of its own.

        :param from_start: False begins with what is printed from now on
        """
        return OutputCursor(self, 0 if from_start else self._end)

    def read(self, at: int) -> tuple[int, bytes]:
        """Return the next text from a position, with the position where it begins: later, where text was dropped."""
        with self._lock:
            for segment in self._segments:
                if at < segment.end:
                    begin = max(at, segment.start)
                    return begin, segment.read(begin)
            return self._end, b""

    @staticmethod
    def _is_full(segment: _Segment) -> bool:
        return segment.end - segment.start >= _SEGMENT


class OutputCursor:
    """One reader's place in the output. Use it from one thread at a time."""

    def __init__(self, log: OutputLog, at: int) -> None:
        self._log, self._at = log, at
        self._decoder = getincrementaldecoder("utf-8")(errors="surrogatepass")
        self._rest = ""

    def read(self, most: int | None = None) -> str:
        """Return what was printed since the last call, empty when there is nothing new.

        :param most: return at most this many characters, and the rest with the next calls
        """
        pieces, length = [self._rest], len(self._rest)
        while (most is None or length < most) and (piece := self._next()):
            pieces.append(piece)
            length += len(piece)
        text = "".join(pieces)
        self._rest = "" if most is None else text[most:]
        return text if most is None else text[:most]

    def read_last(self, most: int) -> str:
        """Return the end of what was printed since the last call, and skip the text before it.

        :param most: the length of that end, in characters
        """
        return self.read()[-most:]

    def _next(self) -> str:
        text = ""
        while not text:  # a piece may end within a character
            begin, data = self._log.read(self._at)
            dropped, self._at = begin - self._at, begin + len(data)
            if dropped:
                self._decoder.reset()
                text = f"[pyfrc: {dropped} bytes of output were dropped here]\n"
            elif not data:
                break
            text += self._decoder.decode(data)
        return text
