"""The processor time of one thread, for those that watch it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

# Bound before these names are patched for robot code.
_process_time, _get_ident = time.process_time, threading.get_ident


def cpu_of_this_thread() -> Callable[[], float]:
    """Return a function that any thread can call for the processor time of the calling thread, in seconds.

    Where the system does not measure it by thread, it is the time of the whole process. When the thread has ended, it
    is infinite: a thread that has ended does not wait.
    """
    if not hasattr(time, "pthread_getcpuclockid"):
        return _process_time
    clock, clock_gettime = time.pthread_getcpuclockid(_get_ident()), time.clock_gettime

    def cpu() -> float:
        try:
            return clock_gettime(clock)
        except OSError:
            return float("inf")

    return cpu
