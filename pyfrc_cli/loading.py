"""The imports of a command, which is where most of its start goes."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from pyfrc_core.collector import collector_paused
from pyfrc_core.display import has_terminal

from .verbosity import verbosity


@contextmanager
def loading() -> Iterator[None]:
    """Import many modules in the ``with`` block.

    If that takes seconds, a line says so at a terminal, unless the user wants it quiet.
    """
    from pyfrc_core.processes.standstill import REPORTED_AFTER, slow_start

    def say() -> None:
        with suppress(OSError):
            print(slow_start(REPORTED_AFTER), file=sys.stderr, flush=True)

    timer = threading.Timer(REPORTED_AFTER, say)
    timer.daemon = True
    with collector_paused():
        if verbosity().quiet or not has_terminal():
            yield
            return
        timer.start()
        try:
            yield
        finally:
            timer.cancel()
            timer.join()  # a process with another thread is not forked
