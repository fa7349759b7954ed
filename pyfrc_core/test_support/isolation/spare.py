"""A fork of this process, kept from before the robot's modules were imported, in case they cannot be forked.

A robot that makes devices or threads when its module is imported (a motor in a class variable) starts threads in
WPILib's C++ that a fork would not have, and that the HAL would wait for. Its tests then run from the spare, where each
test's process imports the robot itself: slower by that import, not by a new interpreter for every test.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable

from ...measure.processes import save_here
from ...runtime.forks import forking_quietly

#: What a pipe holds, at least: the reasons are written and read at once.
_MOST_BYTES = 512


class Spare:
    """The process as it is now, to be gone back to.

    :param work: what the spare does when it takes over; is given the reasons, and returns the exit code
    """

    def __init__(self, work: Callable[[str], int]) -> None:
        self._over = False
        reading_end, self._go = os.pipe()
        sys.stdout.flush()
        sys.stderr.flush()
        with forking_quietly():
            self._pid = os.fork()
        if self._pid == 0:
            os.close(self._go)
            status = 0
            try:
                if reasons := os.read(reading_end, _MOST_BYTES):
                    status = work(reasons.decode(errors="ignore"))
                    save_here()
            finally:
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(status)
        os.close(reading_end)

    def dismiss(self) -> None:
        """It is not needed, or has done its work."""
        if not self._over:
            self._over = True
            # Not by closing the pipe: a process that robot code has left behind may hold it open, too.
            os.kill(self._pid, signal.SIGKILL)
            os.waitpid(self._pid, 0)
            os.close(self._go)

    def take_over(self, reasons: str) -> int:
        """Let the spare do the work instead of this process; return its exit code.

        :param reasons: why this process cannot be forked
        """
        self._over = True
        os.write(self._go, reasons.encode()[:_MOST_BYTES])
        os.close(self._go)
        while True:
            try:
                return os.waitstatus_to_exitcode(os.waitpid(self._pid, 0)[1])
            except KeyboardInterrupt:
                continue  # the spare has got it too, and says what it makes of it
