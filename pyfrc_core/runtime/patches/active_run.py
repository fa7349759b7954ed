"""The run of this process, whose time and connection the replaced names follow."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Protocol

from ...hal import HalData
from ..clock import Clock
from ..connection import DriverStationConnection
from ..threads import cooperative
from ..threads.robot_threads import RobotThread, RobotThreads
from ..time.timed_loop import TimedLoop
from .data_logs import DataLogs
from .loop_watchdog import LoopOverruns
from .notifier import PeriodicThread

if TYPE_CHECKING:
    from . import hal_notifiers


class ExternalWrites(Protocol):
    """A listener for what is written from outside the robot program, such as a recorder."""

    def begin_outside(self, stepping: bool = False, only_time: bool = False) -> None:
        """External writes begin: before a packet, and of the match time alone."""

    def end_outside(self, stepping: bool = False, only_time: bool = False) -> None:
        """External writes end."""

    def on_packet_out_of_turn(self) -> None:
        """A packet is delivered between two of the clock's packets."""


class Run(Protocol):
    """What the replaced names need of `robot.RobotRun`, which is above them; its attributes are explained there."""

    clock: Clock
    connection: DriverStationConnection
    threads: RobotThreads
    alarms: hal_notifiers.Alarms
    overruns: LoopOverruns
    timed_loop: TimedLoop
    data_logs: DataLogs
    recorder: ExternalWrites | None
    in_motion: bool
    own_loop: RobotThread | None
    robot: Any
    renderer: object

    @property
    def started(self) -> bool: ...

    @property
    def hal_data(self) -> HalData: ...

    def at_close(self, call: Callable[[], object]) -> None: ...

    def close(self) -> None: ...

    def sleep_on_robot_thread(self, target_us: int) -> bool: ...


class ActiveRun:
    """The run of this process, if a robot runs.

    There is one of these, since the HAL, the patched names and the threads in robot time belong to the process.
    """

    def __init__(self) -> None:
        self.run: Run | None = None
        #: Called when a robot's initialization is over.
        self.when_started: Callable[[], object] = lambda: None

    @contextlib.contextmanager
    def set_to(self, run: Run) -> Iterator[None]:
        """Make `run` the active one while the context lasts.

        :raises RuntimeError: when there is one already
        """
        if self.run is not None:
            raise RuntimeError("a robot runs already in this process")
        self.run = run
        cooperative.scope.threads = PeriodicThread.threads = run.threads
        try:
            yield
        finally:
            self.forget()

    def forget(self) -> None:
        """Return the process to real time."""
        self.run = None
        cooperative.scope.threads = PeriodicThread.threads = None


#: The run of this process.
active_run = ActiveRun()
