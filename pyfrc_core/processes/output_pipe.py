"""The pipe that robots print into, with a known end.

Other processes that robot code has started may hold the pipe open after the robot's end, so end-of-file says nothing.
This process keeps a writing end of its own, and writes a marker when it wants to know that all before it has been read.
What libraries print about themselves is left out.

A process that has a clock of its own can say when it has printed something, by a `stamp` behind it.
"""

from __future__ import annotations

import os
import re
import threading
from codecs import getincrementaldecoder
from collections.abc import Callable, Sequence
from contextlib import suppress

from ..compat.library_output import LibraryOutput

#: Replaced by tests that need the reading thread to be late.
read = os.read

_MOST_AT_ONCE = 1 << 16

#: The stamps of a text: how many characters are before each, and the time that it says, in microseconds.
Stamps = Sequence[tuple[int, int]]


class OutputPipe:
    """Reads, in a thread of its own, what is written into `writing_end`.

    :param on_text: called with what has been printed, and with its stamps, in that thread
    """

    def __init__(self, on_text: Callable[[str, Stamps], object]) -> None:
        self._on_text = on_text
        self._reading_end, self.writing_end = os.pipe()
        # Nothing that is printed holds these random bytes.
        self._name = b"\0pyfrc-" + os.urandom(16).hex().encode() + b":"
        self._marker = re.compile(re.escape(self._name) + rb"(?:(?P<flush>\d+)|@(?P<time>\d+))\0")
        #: What is printed behind a text to say when that was; formatted with the microseconds.
        self.stamp = f"{self._name.decode()}@{{}}\0"
        self._lock = threading.Lock()
        self._markers = 0
        self._waiting: dict[int, threading.Event] = {}
        self._over = False
        self._thread = threading.Thread(target=self._read, name="pyfrc: output", daemon=True)
        self._thread.start()

    def flush(self) -> None:
        """Wait until all that has been written so far was given to `on_text`."""
        with self._lock:
            if self._over:
                return
            self._markers += 1
            seen = self._waiting[self._markers] = threading.Event()
            self._write_marker(self._markers)
        seen.wait()

    def close(self) -> None:
        """End, when all that has been written so far was given to `on_text`."""
        with self._lock:
            if self._over:
                return
            self._over = True
            self._write_marker(0)
        self._thread.join()
        os.close(self.writing_end)
        os.close(self._reading_end)

    def _write_marker(self, number: int) -> None:
        # Shorter than what a pipe takes in one piece.
        os.write(self.writing_end, self._name + str(number).encode() + b"\0")

    def _read(self) -> None:
        decoder = getincrementaldecoder("utf-8")(errors="replace")
        held, output = b"", LibraryOutput()
        while data := read(self._reading_end, _MOST_AT_ONCE):
            held += data
            text, stamps, at = "", [], 0
            for marker in self._marker.finditer(held):
                text += output.feed(decoder.decode(held[at : marker.start()]))
                at = marker.end()
                if marker["time"] is not None:
                    stamps.append((len(text), int(marker["time"])))
                    continue
                self._pass_on(text + output.flush(), stamps)
                text, stamps = "", []
                if (number := int(marker["flush"])) == 0:  # that of `close`
                    return
                self._waiting.pop(number).set()
            # The beginning of a marker whose rest comes with the next piece.
            start = held.rfind(b"\0", at)
            cut = start if start >= 0 and self._may_begin_a_marker(held[start:]) else len(held)
            self._pass_on(text + output.feed(decoder.decode(held[at:cut])), stamps)
            held = held[cut:]

    def _may_begin_a_marker(self, data: bytes) -> bool:
        rest = data.removeprefix(self._name)
        return self._name.startswith(data) or (rest != data and (rest == b"@" or rest.removeprefix(b"@").isdigit()))

    def _pass_on(self, text: str, stamps: Stamps) -> None:
        if text:
            with suppress(Exception):  # a pipe that is not read any more would stop the robot
                self._on_text(text, stamps)
