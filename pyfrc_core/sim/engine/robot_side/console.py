"""A copy of what robot code prints, for a data log.

Python's streams are copied: what C++ code prints by itself, such as WPILib's warnings about joysticks, goes to the
terminal alone. To have that, too, standard output would have to be a file of this process, and a crash would lose its
end.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, TextIO

from ....processes.lent_streams import replace_streams

Put = Callable[[str], object]


class Console:
    """The lines that are printed in this process from now on. Those before `begin` are kept for it."""

    def __init__(self) -> None:
        self._process = os.getpid()
        self._before: list[str] = []
        self._put: Put = self._before.append
        replace_streams(lambda stream: _Copied(stream, self._add))

    def begin(self, put: Put) -> None:
        """Pass each line to `put`."""
        for line in self._before:
            put(line)
        self._put = put

    def end(self) -> None:
        """Pass on no more."""
        self._put = lambda line: None

    def _add(self, line: str) -> None:
        if os.getpid() == self._process:  # else robot code has forked this process
            self._put(line)


class _Copied:
    """A stream in the place of another one."""

    def __init__(self, stream: TextIO, put: Put) -> None:
        self._stream, self._put, self._open = stream, put, ""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write a text, and pass on the lines that it ends."""
        written = self._stream.write(text)
        *whole, self._open = (self._open + text).split("\n")
        for line in whole:
            self._put(line)
        return written

    def writelines(self, texts: Any) -> None:
        """Write several texts."""
        for text in texts:
            self.write(text)
