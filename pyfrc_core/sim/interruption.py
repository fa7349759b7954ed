"""Whoever ends a simulation from outside, by Ctrl-C or otherwise, lets it write its files and tidy up."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

#: Sent to a program that is to end; and when its terminal is closed, where there is such a signal.
_ENDING = ("SIGTERM", "SIGHUP")


@contextmanager
def ending_like_ctrl_c() -> Iterator[None]:
    """While this lasts, raise KeyboardInterrupt for them, too."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in _ENDING if hasattr(signal, name)]
    # None: another language's handler, which is to stay; SIG_IGN: as by nohup.
    former = {
        number: handler
        for number in numbers
        if (handler := signal.getsignal(number)) is not None and handler is not signal.SIG_IGN
    }
    for number in former:
        signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        for number, handler in former.items():
            signal.signal(number, handler)
