"""Sample the current line of the robot's code, some hundred times a second.

Hand-written because it must sample the robot's thread that is running, also in forks, and none of the code that runs
the robot. pyinstrument samples the thread that started it; it only draws the flame graph.
"""

from __future__ import annotations

import threading
import time
from threading import get_ident
from time import perf_counter_ns, thread_time_ns
from types import FrameType

from ..compat.cpython_private import current_frames
from ..project.robot_files import RobotFiles, is_pyfrc
from ..runtime.patch_table import PatchTable
from ..runtime.patches.install import patches
from ..runtime.robot import RobotRun
from ..runtime.threads.cooperative import real_thread_start
from ..runtime.threads.robot_threads import real_allocate_lock, real_thread_join
from .figures import Figures
from .stopwatch import innermost_line, is_waiting

_SECONDS = 0.0025
#: Longer intervals are cut to this: a process that was suspended did not spend that time on its current line.
_LONGEST_NS = 20_000_000


class Sampler:
    """Samples the lines of the robot's code while a robot runs in this process."""

    def __init__(self, figures: Figures, files: RobotFiles, stacks: bool) -> None:
        self._figures = figures
        self._files = files
        self._stacks = stacks
        self._over = real_allocate_lock()
        self._thread: threading.Thread | None = None
        #: The processor time of each of the loop's threads at its last sample.
        self._computed: dict[int, int] = {}

    def start(self) -> None:
        """Start sampling in this process."""
        if self._thread is not None:
            return
        self._over = real_allocate_lock()
        self._over.acquire()
        self._thread = threading.Thread(target=self._sample, name="pyfrc sampler", daemon=True)
        real_thread_start(self._thread)

    def stop(self) -> None:
        """Stop sampling; the figures are then complete."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._over.release()
            real_thread_join(thread)

    def sample_runs(self, table: PatchTable) -> None:
        """Sample each robot's run, until the table is undone."""
        real_open, real_close = RobotRun.open, RobotRun.close

        def open_run(run: RobotRun) -> None:
            real_open(run)
            self.start()

        def close_run(run: RobotRun) -> None:
            self.stop()
            real_close(run)

        table.patch(RobotRun, "open", open_run)
        table.patch(RobotRun, "close", close_run)

    def clear(self) -> None:
        """Forget the thread, which does not exist in a fork."""
        self._thread = None
        self._computed.clear()

    def _sample(self) -> None:
        # Python's switch interval is not changed: a shorter one would slow down switches between the robot's threads.
        figures, last = self._figures, perf_counter_ns()
        while not self._over.acquire(timeout=_SECONDS):
            now, begin = perf_counter_ns(), thread_time_ns()
            self._take_sample(min(now - last, _LONGEST_NS))
            last = now
            figures.samples += 1
            figures.sampling_ns += thread_time_ns() - begin

    def _take_sample(self, spent_ns: int) -> None:
        run = patches.run
        if run is None or not run.in_motion:
            return
        running = run.threads.running
        ident = running.ident if running is not None else run.threads.driver
        frame = current_frames().get(ident) if ident is not None and ident != get_ident() else None
        loop = run.own_loop
        # The identifier of a thread that may end at any time must not be used.
        if ident is not None and (running is None or (running is loop and not loop.finished)):
            spent_ns = self._computed_since_last_sample(ident, spent_ns)
        line = innermost_line(frame, self._files)
        if line is None or is_waiting(frame, self._files):
            return
        self._figures.on_line(line, spent_ns, 0)
        if self._stacks:
            stack = self._stack(frame)
            self._figures.stacks[stack] = self._figures.stacks.get(stack, 0) + spent_ns

    def _computed_since_last_sample(self, ident: int, wall_ns: int) -> int:
        """Return the processor time of a thread since its last sample, at most the given wall time.

        Where the system has no such clock, and for a thread's first sample, that is the wall time.
        """
        if not hasattr(time, "pthread_getcpuclockid"):
            return wall_ns
        computed_ns = time.clock_gettime_ns(time.pthread_getcpuclockid(ident))
        since_ns = computed_ns - self._computed.get(ident, computed_ns - wall_ns)
        self._computed[ident] = computed_ns
        return min(since_ns, wall_ns)

    def _stack(self, frame: FrameType | None) -> tuple[tuple[str, str, int], ...]:
        """Return the call stack from the robot's outermost function on, without pyfrc's own functions."""
        calls, outermost = [], 0
        while frame is not None:
            code = frame.f_code
            if not is_pyfrc(code.co_filename):
                calls.append((getattr(code, "co_qualname", code.co_name), code.co_filename, frame.f_lineno))
                if self._files.is_robot_code(code.co_filename):
                    outermost = len(calls)
            frame = frame.f_back
        return tuple(reversed(calls[:outermost]))
