"""A fork of this process that waits, in case this process cannot be forked later.

A robot that makes devices or threads when its module is imported (a motor in a class variable) starts threads in
WPILib's C++ that a fork would not have, and that the HAL would wait for. Its tests then run from the process that was
forked before the import, where each test's process imports the robot itself: slower by that import, not by a new
interpreter for every test.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable

from ..interruption import interruption
from .exit import exit_now, flush_output
from .fork import Fork, wait_for_any

#: What a pipe holds, at least: the reasons are written and read at once.
_MOST_BYTES = 512


class PreforkedProcess:
    """This process as it is now, to return to.

    :param work: what the fork does when it takes over; is given the reasons, and returns the exit code
    """

    def __init__(self, work: Callable[[str], int]) -> None:
        self._work = work
        self._reading_end, self._writing_end = os.pipe()
        self._fork = Fork(lambda send: self._wait())
        os.close(self._reading_end)
        self._open = True

    def dismiss(self) -> None:
        """End the fork, which is not needed, or has done its work."""
        # Not by closing the pipe: a process that robot code has left behind may hold it open, too.
        self._fork.kill()
        self._close()

    def take_over(self, reasons: str) -> int:
        """Let the fork do the work instead of this process; return its exit code.

        :param reasons: why this process cannot be forked
        """
        os.write(self._writing_end, reasons.encode()[:_MOST_BYTES])
        self._close()
        while not self._fork.finished:
            try:
                wait_for_any([self._fork.fileno()])
                self._fork.poll()
            except KeyboardInterrupt:
                if interruption.number == signal.SIGTERM:  # which the fork has not received, as it has Ctrl-C
                    self._fork.send_signal(signal.SIGTERM)
        return self._fork.status

    def _close(self) -> None:
        if self._open:
            self._open = False
            os.close(self._writing_end)

    def _wait(self) -> None:
        """Be the fork."""
        os.close(self._writing_end)
        status = 0
        try:
            interruption.begin()
            if reasons := os.read(self._reading_end, _MOST_BYTES):
                status = self._work(reasons.decode(errors="ignore"))
        finally:
            flush_output()
            exit_now(status)
