"""Sample the call stack of the robot's code, some hundred times a second.

Hand-written because it must sample the robot's thread that is running, also in forks, and none of the code that runs
the robot. pyinstrument samples the thread that started it; it only draws the flame graph.
"""

from __future__ import annotations

import threading
from threading import get_ident
from time import perf_counter_ns
from types import FrameType

from ..compat.cpython_private import current_frames
from ..project.robot_files import RobotFiles, is_pyfrc
from ..runtime.patches.install import patches
from ..runtime.threads.cooperative import real_thread_start
from ..runtime.threads.robot_threads import real_allocate_lock, real_thread_join
from .figures import Figures, StackEntry

_SECONDS = 0.0025
#: Longer intervals are cut to this: a process that was suspended did not spend that time on its current line.
_LONGEST_NS = 20_000_000


class Sampler:
    """Samples the robot's code between `start` and `stop`."""

    def __init__(self, figures: Figures, files: RobotFiles) -> None:
        self._figures = figures
        self._files = files
        self._over = real_allocate_lock()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Start sampling in this process."""
        self._over = real_allocate_lock()
        self._over.acquire()
        self._thread = threading.Thread(target=self._sample, name="pyfrc sampler", daemon=True)
        real_thread_start(self._thread)

    def stop(self) -> None:
        """Stop sampling, if it goes on; the figures are then complete."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._over.release()
            real_thread_join(thread)

    def _sample(self) -> None:
        last = perf_counter_ns()
        while not self._over.acquire(timeout=_SECONDS):
            now = perf_counter_ns()
            self._take_sample(min(now - last, _LONGEST_NS))
            last = now

    def _take_sample(self, spent_ns: int) -> None:
        run = patches.run
        if run is None or not run.in_motion:
            return
        running = run.threads.running
        ident = running.ident if running is not None else run.threads.driver
        frame = current_frames().get(ident) if ident is not None and ident != get_ident() else None
        if stack := stack_of(frame, self._files):
            self._figures.stacks[stack] += spent_ns


def stack_of(frame: FrameType | None, files: RobotFiles) -> tuple[StackEntry, ...]:
    """Return the call stack from the robot's outermost function on, without pyfrc's own functions.

    :return: empty if it has no robot code, or if that waits: then other threads run
    """
    calls: list[StackEntry] = []
    outermost = 0
    while frame is not None:
        code = frame.f_code
        if not is_pyfrc(code.co_filename):
            name = getattr(code, "co_qualname", code.co_name)  # since Python 3.11
            calls.append(StackEntry(name, code.co_filename, frame.f_lineno))
            if files.is_robot_code(code.co_filename):
                outermost = len(calls)
        elif not outermost and code.co_name == "wait" and frame.f_globals.get("__package__") == __package__:
            return ()
        frame = frame.f_back
    return tuple(reversed(calls[:outermost]))
