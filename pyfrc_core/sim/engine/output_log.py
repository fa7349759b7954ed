"""What robots have printed, for several readers: each reads all of it, at its own pace.

A robot that prints without end must not fill the memory: beyond `_MOST` characters, the oldest text is dropped.
"""

from __future__ import annotations

import threading
from collections import deque

#: How many characters are kept, and about how many of them in one piece.
_MOST, _PIECE = 1 << 24, 1 << 16


#: What lines of pyfrc's own begin with.
OWN = "[pyfrc] "


class OutputLog:
    """A text that grows at its end. May be used from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pieces: deque[str] = deque([""])
        #: The number of characters before the first piece, and at the end of the last.
        self._begin = self._end = 0

    def append(self, text: str) -> None:
        """Add a text at the end."""
        with self._lock:
            if len(self._pieces[-1]) < _PIECE:
                text_before = self._pieces.pop()
                self._pieces.append(text_before + text)
            else:
                self._pieces.append(text)
            self._end += len(text)
            while self._end - self._begin > _MOST and len(self._pieces) > 1:
                self._begin += len(self._pieces.popleft())

    def cursor(self, from_start: bool = True) -> OutputCursor:
        """Return a reader of its own.

        :param from_start: False begins with what is printed from now on
        """
        return OutputCursor(self, 0 if from_start else self._end)

    def read(self, at: int, most: int | None) -> tuple[int, str]:
        """Return the text from a position, with the position where it begins: later, where text was dropped."""
        with self._lock:
            begin, before, found = max(at, self._begin), self._begin, ""
            if begin < self._end:
                for piece in self._pieces:
                    found += piece[max(begin - before, 0) :]
                    before += len(piece)
                    if most is not None and len(found) >= most:
                        break
            return begin, found[:most]


class OutputCursor:
    """One reader's place in the output. Use it from one thread at a time."""

    def __init__(self, log: OutputLog, at: int) -> None:
        self._log, self._at = log, at

    def read(self, most: int | None = None) -> str:
        """Return what was printed since the last call, empty when there is nothing new.

        :param most: return at most this many characters, and the rest with the next calls
        """
        begin, text = self._log.read(self._at, most)
        dropped, self._at = begin - self._at, begin + len(text)
        return f"[pyfrc: {dropped} characters of output were dropped here]\n{text}" if dropped else text

    def read_last(self, most: int) -> str:
        """Return the end of what was printed since the last call, and skip the text before it.

        :param most: the length of that end, in characters
        """
        return self.read()[-most:]
