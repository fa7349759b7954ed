"""The processor time of one thread, for those that watch it."""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path

# Bound before these names are patched for robot code.
_process_time, _get_ident = time.process_time, threading.get_ident


class ThreadTimes:
    """The times of the thread that creates this, in seconds; any thread may ask."""

    def __init__(self) -> None:
        self._clock: int | None = None
        if hasattr(time, "pthread_getcpuclockid"):
            self._clock = time.pthread_getcpuclockid(_get_ident())
        self._schedule = Path(f"/proc/self/task/{threading.get_native_id()}/schedstat")

    def cpu(self) -> float:
        """Return its processor time; that of the whole process where the system does not measure it by thread.

        When the thread has ended, it is infinite: a thread that has ended does not wait.
        """
        if self._clock is None or sys.platform == "win32":
            return _process_time()
        try:
            return time.clock_gettime(self._clock)
        except OSError:
            return float("inf")

    def starved(self) -> float | None:
        """Return for how long it has waited for a processor of a busy machine. None where the system does not say."""
        try:
            # Not as text: another thread may be importing, for long, and the codec is a module.
            return int(self._schedule.read_bytes().split()[1]) / 1e9
        except (OSError, ValueError, IndexError):
            return None
