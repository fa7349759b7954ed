"""Replace the functions by which robot code waits and reads the time, so that they follow the clock of the run.

All replaced names are in one table. They are replaced once, before the robot's modules are imported, since modules bind
names when they are imported. While no robot runs, and for callers outside the run, each replacement does what the
original does. `time`'s functions return robot time only when the robot project's own files call them: pytest and other
libraries get real time.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from operator import index
from types import ModuleType
from typing import Any

from ...compat.cpython_private import QUEUE_TIME, THREADING_TIME, get_frame
from ...patch_table import Patch, PatchTable
from ...project.robot_files import RobotFiles
from ...wpi import timing
from ..after_import import after_import
from ..clock import KICKOFF as KICKOFF
from ..clock import to_us
from ..threads import cooperative, event_loops, locks
from ..threads.fork_obstacles import library_threads
from ..threads.replacements import as_original
from . import noise, object_hashes, robot_stack, udp_ports, wpilib_names
from .active_run import Run, active_run

_real_sleep = time.sleep

#: Wall seconds in which WPILib's clock goes on in a forked process, unless a lock is held there for ever.
_RESUMES_WITHIN = 1.0


class Patches:
    """The names that are replaced in this process. There is one instance, `patches`, as there is one of each module."""

    def __init__(self) -> None:
        self._files: RobotFiles  # of the project that they were installed for
        self._table = PatchTable()

    @property
    def run(self) -> Run | None:
        """The run of this process, if a robot runs."""
        return active_run.run

    @property
    def installed(self) -> bool:
        return bool(self._table)

    def install(self, files: RobotFiles) -> None:
        """Replace the names, for the robot project with these files. Calling it again only changes the project."""
        self._files = files
        cooperative.scope.is_robot_code = files.is_robot_code
        cooperative.scope.line_of = files.line_of_frame
        if self.installed:
            return
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=_return_to_real_time)
        for patch in self._patches():
            self._patch(patch)
        after_import("rev", self._watch_sparks)
        robot_stack.show_robots_lines(lambda: self._files)
        library_threads.begin()

    def _patch(self, patch: Patch) -> None:
        owner, name, replacement = patch
        original = vars(owner).get(name, getattr(owner, name, None))
        self._table.patch(owner, name, as_original(owner, name, original, replacement))

    def _watch_sparks(self, rev: ModuleType) -> None:
        if self.installed:
            self._patch(noise.spark_patch(rev))

    def uninstall(self) -> None:
        """Restore the original names."""
        self._table.undo()
        cooperative.scope.forget_project()
        robot_stack.show_all_lines()

    # -- the table --------------------------------------------------------------------------------------------

    def _patches(self) -> list[Patch]:
        return [
            *self._time_functions(),
            *locks.patches(),
            *wpilib_names.patches(lambda: self._files),
            *robot_stack.patches(lambda: self._files),
            *udp_ports.patches(),
            *object_hashes.patches(),
        ]

    def _time_functions(self) -> list[Patch]:
        def asked_by_robot_code() -> bool:
            return cooperative.on_behalf_of_robot_code(get_frame(2))

        def reading(name: str, from_us: Callable[[int], float]) -> Patch:
            real = getattr(time, name)

            def read() -> Any:
                if not asked_by_robot_code():
                    return real()
                return from_us(active_run.run.clock.now_us if active_run.run is not None else 0)

            return Patch(time, name, read)

        def sleep(seconds: float, /) -> None:
            __tracebackhide__ = True
            threads = cooperative.scope.taking_part()
            if threads is None or not asked_by_robot_code():
                return _real_sleep(seconds)
            if not isinstance(seconds, float):
                seconds = index(seconds)  # refuses what the real one refuses, as Decimal and numpy's float32
            if seconds < 0:
                raise ValueError("sleep length must be non-negative")
            # A loop of sleep(0) lets other threads, and so time, go on.
            return threads.sleep_until(threads.clock.now_us + max(1, to_us(seconds)))

        def waits_in_threading() -> float:
            # The waiting thread computes the deadlines of conditions and queues, so they go by thread, not by file.
            threads = cooperative.scope.taking_part()
            return real_monotonic() if threads is None else _Instant(threads.time_of_waits())

        real_monotonic = time.monotonic
        return [
            Patch(time, "sleep", sleep),
            reading("time", lambda us: KICKOFF + us / 1_000_000),
            reading("time_ns", lambda us: KICKOFF * 1_000_000_000 + us * 1_000),
            reading("monotonic", lambda us: us / 1_000_000),
            reading("monotonic_ns", lambda us: us * 1_000),
            reading("perf_counter", lambda us: us / 1_000_000),
            reading("perf_counter_ns", lambda us: us * 1_000),
            *event_loops.patches(),
            Patch(*THREADING_TIME.place, waits_in_threading),
            Patch(*QUEUE_TIME.place, waits_in_threading),
        ]


def _return_to_real_time() -> None:
    """In a process that robot code has forked: it has neither the clock nor the HAL's threads."""
    if active_run.run is not None:
        active_run.forget()
        cooperative.scope.forget_project()
        # One of the missing threads may have held the HAL's lock: then WPILib's clock stands, and nothing waits for it.
        resuming = threading.Thread(target=timing.run_freely, daemon=True)
        resuming.start()
        resuming.join(_RESUMES_WITHIN)


class _Instant(float):
    """A time whose sums and differences are whole microseconds.

    Python's own waits compute what is left of a time-out again and again, until nothing is: not even 1e-17 s.
    """

    def __add__(self, other: float) -> _Instant:
        return _Instant(round(float(self) + other, 6))

    def __sub__(self, other: float) -> _Instant:
        return _Instant(round(float(self) - other, 6))


#: The patches of this process.
patches = Patches()
