"""The pipe that robots print into, with a known end.

Other processes that robot code has started may hold the pipe open after the robot's end, so end-of-file says nothing.
This process keeps a writing end of its own, and writes a marker when it wants to know that all before it has been read.
What libraries print about themselves is left out.
"""

from __future__ import annotations

import os
import re
import threading
from codecs import getincrementaldecoder
from collections.abc import Callable
from contextlib import suppress

from ..compat.library_output import LibraryOutput

#: Replaced by tests that need the reading thread to be late.
read = os.read

_MOST_AT_ONCE = 1 << 16


class OutputPipe:
    """Reads, in a thread of its own, what is written into `writing_end`.

    :param on_text: called with what has been printed, in that thread
    """

    def __init__(self, on_text: Callable[[str], object]) -> None:
        self._on_text = on_text
        self._reading_end, self.writing_end = os.pipe()
        # Nothing that is printed holds these random bytes.
        self._name = b"\0pyfrc-" + os.urandom(16).hex().encode() + b":"
        self._marker = re.compile(re.escape(self._name) + rb"(\d+)\0")
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
            while (marker := self._marker.search(held)) is not None:
                self._pass_on(output.feed(decoder.decode(held[: marker.start()])) + output.flush())
                held = held[marker.end() :]
                if (number := int(marker[1])) == 0:  # that of `close`
                    return
                self._waiting.pop(number).set()
            # The beginning of a marker whose rest comes with the next piece.
            start = held.rfind(b"\0")
            cut = start if start >= 0 and self._may_begin_a_marker(held[start:]) else len(held)
            self._pass_on(output.feed(decoder.decode(held[:cut])))
            held = held[cut:]

    def _may_begin_a_marker(self, data: bytes) -> bool:
        return self._name.startswith(data) or (data.startswith(self._name) and data[len(self._name) :].isdigit())

    def _pass_on(self, text: str) -> None:
        if text:
            with suppress(Exception):  # a pipe that is not read any more would stop the robot
                self._on_text(text)
