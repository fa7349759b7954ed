"""Why this process cannot be forked: what importing the project's code has made, and a fork would lack."""

from __future__ import annotations

import os
import sys
import threading
import time
from pathlib import Path

from ...compat.cpython_private import bare_threads, target_of
from ...hal import NOTIFIER, devices_exist, existing_devices
from ...wording import counted
from .cooperative import threads_of_the_project

_NAMED_DEVICES = 3

#: How often, and how far apart in seconds, threads are looked at again before they count.
_LOOKS, _LOOK_SECONDS = 20, 0.005

_real_sleep = time.sleep  # before robot time replaces it


class _LibraryThreads:
    """The threads of libraries that Python does not know, such as those of phoenix6's bus and of urcl's notifier."""

    def __init__(self) -> None:
        self._before: set[int] | None = None
        #: Those that counted at the last look: they need no second one.
        self._counted: set[int] = set()

    def begin(self) -> None:
        """Look at them before the project's code is imported."""
        if self._before is None:
            # Numpy's would be among them, as many as there are processors. They come again in a fork.
            os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
            self._before = self._now()

    def count(self) -> int:
        """Return how many have been started since then.

        One of our own that has just begun, or is about to end, looks like theirs for a moment.
        """
        if self._before is None:
            return 0
        found = self._now() - self._before
        for _ in range(_LOOKS):
            if found <= self._counted:
                break
            _real_sleep(_LOOK_SECONDS)
            found &= self._now()
        self._counted = found
        return len(found)

    def _now(self) -> set[int]:
        if sys.platform != "linux":  # nowhere else are processes forked
            return set()
        known = {thread.native_id for thread in threading.enumerate()} | bare_threads
        return {int(task.name) for task in Path("/proc/self/task").iterdir()} - known


library_threads = _LibraryThreads()


def reasons_not_to_fork() -> list[str]:
    """Return what the project's code has made in this process and a fork of it would lack: threads and devices."""
    reasons = [f"{line} starts {_described(thread)}" for thread, line in threads_of_the_project()]
    if devices_exist():
        devices, urcl = existing_devices(), "urcl" in sys.modules
        if urcl:
            reasons.append("`import urcl` makes a notifier")
            devices = [each for each in devices if each != NOTIFIER]
        if devices or not urcl:
            more = f" and {len(devices) - _NAMED_DEVICES} more" if len(devices) > _NAMED_DEVICES else ""
            reasons.append(f"devices are made: {', '.join(devices[:_NAMED_DEVICES])}{more}")
    if not reasons and (count := library_threads.count()) > 0:
        reasons.append(f"libraries start {counted(count, 'thread')}")
    return reasons


def _described(thread: threading.Thread) -> str:
    target = target_of(thread) or type(thread)
    name = getattr(target, "__qualname__", type(thread).__qualname__)
    module = getattr(target, "__module__", None)
    return f"the thread {thread.name!r}, which runs {module}.{name}" if module else f"the thread {thread.name!r}"
