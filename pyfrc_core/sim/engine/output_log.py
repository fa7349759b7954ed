"""What robots have printed, for several readers: each reads all of it, at its own pace.

What Python code has printed comes with the robot time at which it did, so that no reader has to be quick.

A robot that prints without end must not fill the memory: beyond `_MOST` characters, the oldest text is dropped.
"""

from __future__ import annotations

import threading
from collections import deque
from itertools import takewhile

from ...processes.output_pipe import Stamps

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
        #: The same numbers where robot times are known, with these.
        self._stamps: deque[tuple[int, int]] = deque()

    def append(self, text: str, stamps: Stamps = ()) -> None:
        """Add a text at the end."""
        with self._lock:
            for length, time_us in stamps:
                if self._stamps and self._stamps[-1][1] == time_us:  # one for all that a loop prints
                    self._stamps.pop()
                self._stamps.append((self._end + length, time_us))
            if len(self._pieces[-1]) < _PIECE:
                text_before = self._pieces.pop()
                self._pieces.append(text_before + text)
            else:
                self._pieces.append(text)
            self._end += len(text)
            while self._end - self._begin > _MOST and len(self._pieces) > 1:
                self._begin += len(self._pieces.popleft())
            while self._stamps and self._stamps[0][0] <= self._begin:
                self._stamps.popleft()

    def cursor(self, from_start: bool = True) -> OutputCursor:
        """Return a reader of its own.

        :param from_start: False begins with what is printed from now on
        """
        return OutputCursor(self, 0 if from_start else self._end)

    def read(self, at: int, most: int | None) -> tuple[int, str, list[tuple[int, int]]]:
        """Return the text from a position, with its stamps.

        :returns: first, the position where it begins: later, where text was dropped
        """
        with self._lock:
            begin, before, found = max(at, self._begin), self._begin, ""
            if begin < self._end:
                for piece in self._pieces:
                    found += piece[max(begin - before, 0) :]
                    before += len(piece)
                    if most is not None and len(found) >= most:
                        break
            found = found[:most]
            stamps = takewhile(lambda stamp: stamp[0] > begin, reversed(self._stamps))
            return begin, found, [(min(end - begin, len(found)), us) for end, us in stamps][::-1]


class OutputCursor:
    """One reader's place in the output. Use it from one thread at a time."""

    def __init__(self, log: OutputLog, at: int) -> None:
        self._log, self._at = log, at

    def read(self, most: int | None = None) -> str:
        """Return what was printed since the last call, empty when there is nothing new.

        :param most: return at most this many characters, and the rest with the next calls
        """
        return "".join(text for text, _ in self.read_timed(most))

    def read_timed(self, most: int | None = None) -> list[tuple[str, float | None]]:
        """Return the same in pieces, each with the robot time of its end in seconds, if that is known."""
        begin, text, stamps = self._log.read(self._at, most)
        dropped, self._at = begin - self._at, begin + len(text)
        pieces: list[tuple[str, float | None]] = []
        if dropped:
            pieces.append((f"[pyfrc: {dropped} characters of output were dropped here]\n", None))
        at = 0
        for end, time_us in stamps:
            if end > at:
                pieces.append((text[at:end], time_us / 1_000_000))
                at = end
        return [*pieces, (text[at:], None)] if at < len(text) else pieces

    def read_last(self, most: int) -> str:
        """Return the end of what was printed since the last call, and skip the text before it.

        :param most: the length of that end, in characters
        """
        return self.read()[-most:]
