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
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import hal
import hal.simulation
import wpilib
import wpilib.simulation

from ...compat.cpython_private import QUEUE_TIME, THREADING_TIME, get_frame
from ...wpi import robots, timing
from ..after_import import after_import
from ..clock import KICKOFF as KICKOFF
from ..clock import to_us
from ..exceptions import TestEnded
from ..patch_table import Patch, PatchTable
from ..threads import cooperative, event_loops, locks
from ..threads.fork_obstacles import library_threads
from ..threads.replacements import as_original
from . import (
    counters,
    data_logs,
    driver_station,
    hal_resets,
    noise,
    object_hashes,
    robot_stack,
    sysid_logs,
    udp_ports,
)
from .active_run import Run, active_run
from .loop_watchdog import Watchdog
from .notifier import Notifier

if TYPE_CHECKING:
    from ...project.robot_files import RobotFiles

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
            *self._waiting_in_wpilib(),
            *self._stepping_in_tests(),
            *driver_station.patches(),
            *hal_resets.patches(),
            *self._timed_robot(),
            *self._directories(),
            Patch(wpilib.RobotController, "isBrownedOut", _is_browned_out),
            *counters.patches(),
            *robot_stack.patches(lambda: self._files),
            *data_logs.patches(lambda: None if active_run.run is None else active_run.run.data_logs),
            *sysid_logs.patches(),
            *udp_ports.patches(),
            *noise.patches(),
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

    def _waiting_in_wpilib(self) -> list[Patch]:
        def wait(seconds: float) -> None:
            __tracebackhide__ = True
            threads = cooperative.scope.taking_part()
            if threads is None:
                return _real_sleep(seconds)
            return threads.sleep_until(threads.clock.now_us + max(0, to_us(seconds)))

        def notifier_call(name: str, ours: str) -> Patch:
            real = getattr(hal, name)

            def call(*args: object, **kwargs: object) -> Any:
                __tracebackhide__ = True
                run = active_run.run
                handle = args[0] if args else kwargs.get("notifierHandle")
                if run is not None and (handle is None or handle in run.alarms):
                    return getattr(run.alarms, ours)(*args, **kwargs)
                return real(*args, **kwargs)

            return Patch(hal, name, call)

        real_set_name = hal.setNotifierName

        def set_notifier_name(notifierHandle: int, name: str) -> Any:
            ours = active_run.run is not None and notifierHandle in active_run.run.alarms
            return 0 if ours else real_set_name(notifierHandle, name)

        return [
            Patch(wpilib, "wait", wait),
            Patch(wpilib, "Notifier", Notifier),
            Patch(wpilib, "Watchdog", Watchdog),
            notifier_call("initializeNotifier", "initialize"),
            notifier_call("updateNotifierAlarm", "update"),
            notifier_call("cancelNotifierAlarm", "cancel"),
            notifier_call("waitForNotifierAlarm", "wait"),
            notifier_call("stopNotifier", "stop"),
            notifier_call("cleanNotifier", "clean"),
            Patch(hal, "setNotifierName", set_notifier_name),
        ]

    def _stepping_in_tests(self) -> list[Patch]:
        """Tests that step WPILib's simulated time themselves move the robot with it."""

        def stepping(owner: object, name: str, in_us: Callable[[float], int]) -> Patch:
            real = getattr(owner, name)

            def step(delta: float) -> None:
                __tracebackhide__ = True
                run = active_run.run
                if run is None:
                    real(delta)
                    return
                target_us = run.clock.now_us + in_us(delta)
                if run.sleep_on_robot_thread(target_us):
                    return
                try:
                    run.clock.run_until(target_us)
                except TestEnded:
                    if run.threads.failure is None:
                        raise
                    raise run.threads.failure from None  # to the test, which has called this

            return Patch(owner, name, step)

        def left_to_the_run(owner: object, name: str) -> Patch:
            real = getattr(owner, name)

            def call() -> None:
                if active_run.run is None:
                    real()

            return Patch(owner, name, call)

        table = []
        for owner, in_us in ((wpilib.simulation, to_us), (hal.simulation, int)):
            table += [stepping(owner, "stepTiming", in_us), stepping(owner, "stepTimingAsync", in_us)]
            # Time stands still between steps already, and begins at 0 with the run.
            table += [left_to_the_run(owner, f"{verb}Timing") for verb in ("pause", "resume", "restart")]
            table.append(left_to_the_run(owner, "waitForProgramStart"))
        return table

    def _timed_robot(self) -> list[Patch]:
        TimedRobot = wpilib.TimedRobot
        real_add, real_start = TimedRobot.addPeriodic, TimedRobot.startCompetition
        real_end = TimedRobot.endCompetition
        real_loop_start = TimedRobot.getLoopStartTime
        real_turn: Callable[[wpilib.IterativeRobotBase], None] = robots.LOOP_FUNCTION.find()

        # Under its original name: profiles and the limit of a loop recognize it by that.
        def _loopFunc(robot: wpilib.IterativeRobotBase) -> None:
            __tracebackhide__ = True
            run = active_run.run
            if run is None:
                return real_turn(robot)
            began_us = run.clock.now_us
            real_turn(robot)
            if run.clock.now_us != began_us:
                run.overruns.look(robot, began_us)
            return None

        def add_periodic(
            robot: wpilib.TimedRobot, callback: Callable[[], None], period: float, offset: float = 0.0
        ) -> None:
            if active_run.run is None:
                real_add(robot, callback, period, offset)
            else:
                active_run.run.timed_loop.add(robot, callback, period, offset)

        # Under its original name, too: otherwise WPILib's own takes it for the method of a derived class, and calls it.
        def startCompetition(robot: wpilib.TimedRobot) -> None:
            __tracebackhide__ = True
            if active_run.run is None:
                return real_start(robot)
            active_run.run.timed_loop.begin(robot)
            return active_run.run.timed_loop.run_blocking(active_run.run.threads)

        def endCompetition(robot: wpilib.TimedRobot) -> None:
            run = active_run.run
            if run is not None and run.started:  # before that, only its alarm is cancelled: see `construction`
                run.timed_loop.stopped = True
            real_end(robot)

        def loop_start_time(robot: wpilib.TimedRobot) -> Any:
            return real_loop_start(robot) if active_run.run is None else active_run.run.timed_loop.loop_start_us

        return [
            Patch(TimedRobot, "addPeriodic", add_periodic),
            Patch(TimedRobot, "startCompetition", startCompetition),
            Patch(TimedRobot, "endCompetition", endCompetition),
            Patch(TimedRobot, "getLoopStartTime", loop_start_time),
            Patch(*robots.LOOP_FUNCTION.place, _loopFunc),
        ]

    def _directories(self) -> list[Patch]:
        """WPILib takes the directory of whichever program was started for the robot's."""
        return [
            Patch(wpilib, "getOperatingDirectory", lambda: str(Path(self._files.root))),
            Patch(wpilib, "getDeployDirectory", lambda: str(Path(self._files.root, "deploy"))),
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


def _is_browned_out() -> bool:
    """Return whether the battery is too weak for the roboRIO's outputs: the simulated HAL always returns False."""
    controller = wpilib.RobotController
    return controller.getBatteryVoltage() < controller.getBrownoutVoltage()


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
