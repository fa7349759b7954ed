"""Handle Ctrl-C and termination signals so that a program can write its files and clean up before it ends."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import FrameType

#: Signals that end a program, and the one for a closed terminal, where it exists.
_ENDING = ("SIGTERM", "SIGHUP")

_Handler = Callable[[int, FrameType | None], object]


class Interruption:
    """Raise KeyboardInterrupt for signals until the program has begun to finish."""

    def __init__(self) -> None:
        self._ending = self._finishing = False

    def finish(self) -> None:
        """Ignore further signals: files are being written."""
        self._finishing = True

    def handle(self, number: int, frame: FrameType | None) -> None:
        """Raise KeyboardInterrupt; only once for a closed terminal, which the system and the shell both report."""
        again, self._ending = self._ending, self._ending or number != signal.SIGINT
        if not (self._finishing or again):
            raise KeyboardInterrupt


@contextmanager
def ending_like_ctrl_c() -> Iterator[Interruption]:
    """Raise KeyboardInterrupt for termination signals, too, while the context lasts."""
    interruption = Interruption()
    with _handling((*_ENDING, "SIGINT"), interruption.handle):
        yield interruption


def calling_when_ended(call: Callable[[], object]) -> AbstractContextManager[None]:
    """Call a function for Ctrl-C and termination signals, instead of raising an exception, while the context lasts.

    For event loops in C, which an exception does not reliably end.
    """
    return _handling((*_ENDING, "SIGINT"), lambda number, frame: call())


@contextmanager
def _handling(names: tuple[str, ...], handle: _Handler) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    # None: a handler that was not set by Python, which stays; SIG_IGN: as set by nohup.
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
