"""One run of a robot program: the robot, its clock, its threads, from construction to its end.

Tests, the simulator and replay all run a robot through this. Which of the two ways the loop is driven (in place for
WPILib's `TimedRobot`, on a robot thread for robots with a loop of their own) shows nowhere outside.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any

from ..hal import HalData, devices_exist
from ..hal.output_gate import OutputGate
from ..hal.reset import forget_inputs
from ..processes.exit import in_this_process
from ..wpi import network, robots, station, timing, watchdogs
from .clock import OBSERVE, PACKET_US, Clock
from .connection import DriverStationConnection
from .exceptions import TestEnded, TestFroze, WrongThread
from .patches import hal_notifiers
from .patches.active_run import ExternalWrites, active_run
from .patches.construction import missing_super_init, without_first_alarm
from .patches.data_logs import DataLogs, LogPlace
from .patches.loop_watchdog import LoopOverruns
from .patches.object_hashes import restart_numbers
from .threads import cooperative
from .threads.robot_threads import RobotThread, RobotThreads
from .time.motor_safety import MotorSafetyCheck
from .time.simulation_periodic import gate_robot, gate_subsystems
from .time.timed_loop import TimedLoop


class RobotRun:
    """A robot from its construction to its end, in robot time.

    The thread that creates this drives the clock. The HAL is one per process, so only one run at a time can be.

    :param logs: where the data logs that robot code starts are written; None: they are not kept
    :param has_devices: whether devices exist in the HAL, if the caller knows; None: they are searched
    :param start_us: the robot time at which it begins
    """

    def __init__(
        self,
        logs: LogPlace | None = None,
        has_devices: bool | None = None,
        start_us: int = 0,
    ) -> None:
        self._has_devices = has_devices
        self.clock = Clock(start_us)
        #: What robot code starts of data logs.
        self.data_logs = DataLogs(self.clock, logs)
        #: What brings packets to the robot.
        self.connection = DriverStationConnection()
        self.clock.deliver_packet = self.connection.packet
        self.threads = RobotThreads(self.clock)
        self.alarms = hal_notifiers.Alarms(self.threads)
        self.overruns = LoopOverruns(self.clock)
        self.timed_loop = TimedLoop(self.clock, self.clock.now_us, self._on_initialized, self.overruns.count)
        #: When the turn of the loop began that the robot is in, in microseconds; None between two turns.
        self.turn_began: Callable[[], int | None] = lambda: None
        self.robot: Any = None
        #: Called when the robot has been constructed, and when its `robotInit` is over (see `initializes`).
        self.when_constructed: list[Callable[[], object]] = []
        self.when_initialized: list[Callable[[], object]] = []
        #: Called within the loop when robot code has simulated something (`time.simulation_periodic`).
        self.when_simulated: list[Callable[[], object]] = []
        #: The recorder of external writes, if there is one.
        self.recorder: ExternalWrites | None = None
        #: Called with what is written to NetworkTables from outside: the target, as in scripts, and the value.
        self.when_network_written: list[Callable[[str, Any], object]] = []
        #: What moves the robot's sensors, if the project has physics.
        self.physics: object = None
        #: What robot code draws on the field with, where there is a field to be seen.
        self.renderer: object = None
        #: Threads that did not stop when the run ended.
        self.still_running: list[RobotThread] = []
        #: Whether the robot's code is being run; while it is not, it cannot be what takes long.
        self.in_motion = False
        #: The thread of a robot that has a loop of its own.
        self.own_loop: RobotThread | None = None
        #: Whether `start` runs the robot's own initialisation, which may wait.
        self.starting = False
        self._started = self._ended = False
        self._closing = contextlib.ExitStack()

    def at_close(self, call: Callable[[], object]) -> None:
        """Call this before the HAL is released."""
        self._closing.callback(call)

    def open(self) -> None:
        """Acquire the HAL: time at 0, a robot that has just booted, no packet delivered yet."""
        restart_numbers()
        self._closing.enter_context(active_run.set_to(self))
        network.start()
        has_devices = devices_exist() if self._has_devices is None else self._has_devices
        if not has_devices:  # of an earlier run in this process, only its inputs are left
            forget_inputs()
        self.connection.boot()
        # What the first packet brings: it may still be changed.
        station.reset_driver_station()
        self.clock.before_packet.append(MotorSafetyCheck().on_packet)
        watchdogs.end_watchdog_thread()
        self.data_logs.start_as_at_import()
        cooperative.begin_waiting_threads()

    def construct(self, robot_class: type[object]) -> Any:
        """Make the robot. Its `robotInit` runs with `start`."""
        __tracebackhide__ = True
        try:
            with self._failing(), without_first_alarm():
                self.robot = robot_class()
        except TypeError as error:
            raise missing_super_init(robot_class, error) or error from None
        if self.when_initialized:
            robots.when_initialized(self.robot, self._on_initialized)
        gate_robot(self.robot, lambda: self.output_gate, self._on_simulated)
        for listener in self.when_constructed:
            listener()
        return self.robot

    @property
    def initializes(self) -> bool:
        """Whether the end of `robotInit` is known: of robots with WPILib's loop, and of `MagicRobot`."""
        return robots.reports_initialization(self.robot)

    def _on_initialized(self) -> None:
        __tracebackhide__ = True
        gate_subsystems(lambda: self.output_gate, self._on_simulated)
        for listener in self.when_initialized:
            listener()

    def _on_simulated(self) -> None:
        for listener in self.when_simulated:
            listener()

    @cached_property
    def hal_data(self) -> HalData:
        """The robot's inputs and outputs: one tree for all users of this run."""
        tree = HalData(defaults=False)
        # What was written for a gyro before the robot made it, reaches it then.
        self.clock.before_packet.append(lambda now: tree.sync())
        return tree

    @cached_property
    def output_gate(self) -> OutputGate:
        """What turns outputs off while physics look at a robot that is disabled."""
        return OutputGate()

    @property
    def alive(self) -> bool:
        """Whether the robot program has started and has neither ended nor failed."""
        if not self._started or self._ended or self.threads.failure is not None:
            return False
        if self.own_loop is not None:
            return not self.own_loop.finished
        return not self.timed_loop.stopped

    @property
    def started(self) -> bool:
        return self._started

    def start(self) -> None:
        """Begin the robot program: `robotInit`, then whatever its loop does at time 0."""
        __tracebackhide__ = True
        with self._failing(), self._while_starting():
            self._started = True
            if robots.has_loop_of_its_own(self.robot):
                thread = threading.Thread(target=self._compete, name="robot", daemon=True)
                cooperative.start_in_robot_time(thread)
                self.own_loop = cooperative.record_of(thread)
                if self.own_loop is not None:
                    self.own_loop.is_the_robot = True
                self.clock.run_until(self.clock.now_us)
            else:
                self.timed_loop.begin(self.robot)
                self.timed_loop.run_in_place()
        active_run.when_started()

    @contextlib.contextmanager
    def _while_starting(self) -> Iterator[None]:
        self.starting = True
        try:
            yield
        finally:
            self.starting = False

    def do(self, action: Callable[[], object]) -> None:
        """Call code of the user's that takes part in the run."""
        __tracebackhide__ = True
        with self._failing():
            action()

    def run_until(self, target_us: int) -> None:
        """Let the robot run until `target_us`, raising what its code raises.

        A thread of the robot sleeps until then, as with `time.sleep`.

        :raises WrongThread: on a thread that does not live in robot time
        """
        __tracebackhide__ = True
        if not self.sleep_on_robot_thread(target_us):
            with self._failing():
                self.clock.run_until(target_us)

    def sleep_on_robot_thread(self, target_us: int) -> bool:
        """Sleep until `target_us` if one of the robot's threads calls this, and return whether it does.

        :raises WrongThread: on a thread that does not live in robot time
        """
        __tracebackhide__ = True
        if not self._on_robot_thread("let robot time pass"):
            return False
        self.threads.sleep_until(target_us)
        return True

    def check_drives_clock(self, what: str) -> None:
        """Raise an error unless the calling thread is the one that drives the clock.

        :param what: what it is about to do, completing "cannot ..."
        :raises WrongThread: on every other thread
        """
        __tracebackhide__ = True
        if self._on_robot_thread(what):
            raise WrongThread(
                f"the thread {threading.current_thread().name!r} cannot {what}: it sleeps in robot time",
                remedy="do it in the test itself, not in a thread",
            )

    def check_can_set_time_back(self) -> None:
        """Raise an error unless robot time can be set back: by the thread that drives it, before the robot starts."""
        __tracebackhide__ = True
        self.check_drives_clock("set robot time back")
        if self.started:
            raise RuntimeError("the robot is running: its time can only be set back before run_test() or run_robot()")

    def _on_robot_thread(self, what: str) -> bool:
        """Whether the calling thread is one of the robot's, and not the one that drives the clock.

        :raises WrongThread: when it is neither
        """
        __tracebackhide__ = True
        if threading.get_ident() == self.threads.driver:
            return False
        if self.threads.current() is not None:
            return True
        name = threading.current_thread().name
        raise WrongThread(
            f"the thread {name!r} cannot {what}: it does not live in robot time",
            remedy="only the test itself and the robot's own threads can",
        )

    def next_packet(self) -> None:
        """Let the robot run to the next driver-station packet and through everything that is due with it."""
        self.run_until(self.clock.next_packet_us)

    def observe(self, look: Any) -> None:
        """Have `look` called after every packet, when the robot has done its part: ``look(now_in_seconds)``."""
        clock = self.clock
        clock.every(PACKET_US, OBSERVE, lambda: look(clock.now_us / 1_000_000))

    def overruns_until_now(self) -> tuple[int, int]:
        """Return how many turns of the loop took longer than its period, and the longest, in microseconds.

        A turn that still goes on counts as one as soon as it is late.
        """
        number, longest_us = self.overruns.number, self.overruns.longest_us
        began_us = self.turn_began()
        if began_us is not None:
            took_us = self.clock.now_us - began_us
            if took_us > PACKET_US:
                return number + 1, max(longest_us, took_us)
        return number, longest_us

    def end(self) -> None:
        """End the robot program and its threads; time stands still from here on."""
        __tracebackhide__ = True
        if self._ended:
            return
        self._ended = True
        self.timed_loop.stopped = True
        try:
            if self._started and self.threads.failure is None:
                with contextlib.suppress(TestEnded), self._failing():
                    robots.end(self.robot)
        finally:
            try:
                self._end_threads()
            finally:
                self.data_logs.close()

    def _end_threads(self) -> None:
        __tracebackhide__ = True
        self.in_motion = True
        try:
            self.still_running = self.threads.end(cooperative.line_of_thread)
        except TestFroze:
            if self.threads.failure is None:  # the first failure is the one to report
                raise
        finally:
            self.in_motion = False

    def close(self) -> None:
        """Release the HAL."""
        try:
            self.end()
        finally:
            self._closing.close()
            network.stop()
            # What is still due, the loop and the physics hold on to the robot.
            self.clock.forget()
            self.when_constructed.clear()
            self.when_initialized.clear()
            self.timed_loop = TimedLoop(self.clock, 0, self._on_initialized, self.overruns.count)
            robots.release(self.robot)
            self.robot = self.physics = None
            timing.run_freely()

    def _compete(self) -> None:
        __tracebackhide__ = True
        robots.compete(self.robot)

    @contextlib.contextmanager
    def _failing(self) -> Any:
        """Raise the failure once, on the driving thread, instead of the `TestEnded` that unwound the robot."""
        __tracebackhide__ = True
        before, self.in_motion = self.in_motion, True
        if self.recorder is not None:
            self.recorder.end_outside()
        try:
            with in_this_process():
                yield
        except TestEnded:
            if self.threads.failure is None:
                raise
            raise self.threads.failure from None
        except (Exception, TestFroze) as failure:
            self.threads.fail(failure)
            raise
        finally:
            self.in_motion = before
            if self.recorder is not None:
                self.recorder.begin_outside()
