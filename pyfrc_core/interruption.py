"""Whoever ends a simulation from outside, by Ctrl-C or otherwise, lets it write its files and tidy up."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType

#: Sent to a program that is to end; and when its terminal is closed, where there is such a signal.
_ENDING = ("SIGTERM", "SIGHUP")

_Handler = Callable[[int, FrameType | None], object]


class Interruption:
    """Raises KeyboardInterrupt for signals, as long as there is something to interrupt."""

    def __init__(self) -> None:
        self._ending = self._finishing = False

    def finish(self) -> None:
        """Raise it no more: files are written now."""
        self._finishing = True

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Raise it; for a terminal that is closed once only, since the system and the shell both tell of that."""
        again, self._ending = self._ending, self._ending or number != signal.SIGINT
        if not (self._finishing or again):
            raise KeyboardInterrupt


@contextmanager
def ending_like_ctrl_c() -> Iterator[Interruption]:
    """While this lasts, raise KeyboardInterrupt for them, too."""
    interruption = Interruption()
    with _handling((*_ENDING, "SIGINT"), interruption.handle):
        yield interruption


def calling_when_ended(call: Callable[[], object]) -> AbstractContextManager[None]:
    """While this lasts, have them and Ctrl-C raise nothing, but call this.

    For loops in C, which exceptions do not end wherever they are raised.
    """
    return _handling((*_ENDING, "SIGINT"), lambda number, frame: call())


@contextmanager
def _handling(names: tuple[str, ...], handle: _Handler) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    # None: another language's handler, which is to stay; SIG_IGN: as by nohup.
    former = {
        number: handler
        for number in numbers
        if (handler := signal.getsignal(number)) is not None and handler is not signal.SIG_IGN
    }
    for number in former:
        signal.signal(number, handle)
    try:
        yield
    finally:
        for number, handler in former.items():
            signal.signal(number, handler)
