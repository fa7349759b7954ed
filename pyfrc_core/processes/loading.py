"""Imports of many modules, which take seconds on some computers: where a virus scanner reads each file, for example."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from ..collector import collector_paused
from ..display import has_terminal
from .standstill import REPORTED_AFTER, slow_start


@contextmanager
def loading(quiet: bool = False) -> Iterator[None]:
    """Import many modules in the ``with`` block.

    If that takes seconds, a line says so at a terminal.

    :param quiet: whether the user wants no such lines
    """

    def say() -> None:
        with suppress(OSError):
            print(slow_start(REPORTED_AFTER), file=sys.stderr, flush=True)

    timer = threading.Timer(REPORTED_AFTER, say)
    timer.daemon = True
    with collector_paused():
        if quiet or not has_terminal():
            yield
            return
        timer.start()
        try:
            yield
        finally:
            timer.cancel()
            timer.join()  # a process with another thread is not forked
