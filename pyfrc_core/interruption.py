"""Ctrl-C and the signals that end a program: it writes its files and cleans up before it ends.

While a command runs, each of them raises `KeyboardInterrupt`. The command's exit code is then 128 plus the signal's
number, as in a shell: 130 for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

#: Ctrl-C, the signal that ends a program, and the one for a closed terminal, where it exists.
_ENDING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


class Interruption:
    """The signal that has ended this process's command.

    :ivar number: its number; None: the command has not been interrupted
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self._call: Callable[[], object] | None = None
        self._finishing = self._over = False
        self._process = 0

    def begin(self) -> None:
        """Handle signals from now on, but those that are ignored, as nohup has it. Forks of this process do not."""
        self._process = os.getpid()
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._leave)
        for number in _ENDING:
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                signal.signal(number, self._handle)

    def _leave(self) -> None:
        for number in _ENDING:
            if signal.getsignal(number) == self._handle:
                signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)

    def finish(self) -> None:
        """Ignore further signals: files are being written."""
        self._finishing = True

    def end(self) -> None:
        """Let a further signal end the process at once: the result was printed.

        Python may still wait for threads, and would print a traceback or end by the signal.
        """
        self._over = True

    def check(self, error: BaseException) -> None:
        """Raise KeyboardInterrupt if the command was interrupted: an error that robot code raises then comes of that.

        A library in C++ that is being imported reports Ctrl-C as a failed import.
        """
        if self.number is not None:
            raise KeyboardInterrupt from error

    def exit_code(self, status: int) -> int:
        """Return the exit code of a command.

        :param status: that of a command that was not interrupted
        """
        return status if self.number is None else 128 + self.number

    @contextmanager
    def calling(self, call: Callable[[], object]) -> Iterator[None]:
        """Call a function instead of raising an exception, while the context lasts.

        For event loops in C, which an exception does not reliably end.
        """
        before, self._call = self._call, call
        try:
            yield
        finally:
            self._call = before

    def _handle(self, number: int, frame: FrameType | None) -> None:
        __tracebackhide__ = True
        if os.getpid() != self._process:  # a fork that has not left yet: a signal of the command's may be pending in it
            return
        if self._over:
            os._exit(self.exit_code(128 + number))
        # Only once for a closed terminal, which the system and the shell both report.
        if self._finishing or self.number not in (None, signal.SIGINT):
            return
        self.number = self.number or number
        if self._call is None:
            raise KeyboardInterrupt
        self._call()


#: Of this process.
interruption = Interruption()
