"""What robot code prints, with the robot time at which it does: for the simulation's console, and for a data log.

Only Python's streams know it: what C++ code prints by itself, such as WPILib's warnings about joysticks, is in no data
log, and has no time of its own in the console. To have that, too, standard output would have to be a file of this
process, and a crash would lose its end.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, TextIO

from ....processes.lent_streams import replace_streams
from ....runtime.clock import Clock

#: Takes the microseconds of robot time, and a line.
Put = Callable[[int, str], object]


class PrintedOutput:
    """What is printed in this process from now on.

    :param stamp: what to print behind each text that ends a line; see `OutputPipe`
    :param keeps: whether to keep lines for `begin`
    """

    def __init__(self, clock: Clock, stamp: str, keeps: bool) -> None:
        self._clock, self._stamp = clock, stamp
        self._process = os.getpid()
        self._before: list[str] = []
        self._put: Put | None = (lambda now_us, line: self._before.append(line)) if keeps else None
        replace_streams(lambda stream: _Stamped(stream, self))

    def begin(self, put: Put) -> None:
        """Pass each line to `put`."""
        for line in self._before:
            put(self._clock.now_us, line)
        self._put = put

    def end(self) -> None:
        """Pass on no more."""
        self._put = None

    @property
    def keeps(self) -> bool:
        """Whether anyone wants the lines."""
        return self._put is not None

    def stamp_for(self, lines: str) -> str:
        """Note whole lines, and return the stamp for them."""
        if os.getpid() != self._process:  # robot code has forked this one: the clock stands still
            return ""
        now_us = self._clock.now_us
        if (put := self._put) is not None:
            for line in lines.split("\n"):
                put(now_us, line)
        return self._stamp.format(now_us)


class _Stamped:
    """A stream in the place of another one."""

    def __init__(self, stream: TextIO, console: PrintedOutput) -> None:
        self._stream, self._console, self._open = stream, console, ""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write a text, with a stamp behind the lines that it ends."""
        lines, newline, rest = text.rpartition("\n")
        if newline:
            # In one piece, or the end of the process might come between.
            self._stream.write(f"{lines}\n{self._console.stamp_for(self._open + lines)}{rest}")
            self._open = ""
        else:
            self._stream.write(text)
        if self._console.keeps:
            self._open += rest
        return len(text)

    def writelines(self, texts: Any) -> None:
        """Write several texts."""
        for text in texts:
            self.write(text)
