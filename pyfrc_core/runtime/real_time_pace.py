"""The least real time that a packet takes while a vendor's library simulates its devices in real time.

Such a device responds after some milliseconds of real time. A run without a limit passes many packets in them: a loop
that is closed in the motor's controller then sees its sensor late, overshoots, and does so differently in each run.
Where no such loop is closed and no device's motion is computed (`real_time_loops`), and while the robot is
disabled, nothing waits.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..compat.unrepeatable import real_time_libraries
from ..patch_table import PatchTable
from ..wpi import station
from .robot_time import PACKET_US
from .time.real_time_loops import RealTimeLoops

if TYPE_CHECKING:
    from ..config.settings import Settings
    from .robot import RobotRun

# As they are before robot time replaces them.
_real_clock, _real_sleep = time.perf_counter, time.sleep


class RealTimePace:
    """Makes a run with such devices wait before a packet, if the last one began too short a time ago.

    A packet that took long leaves nothing to catch up on: devices need the time of each packet.

    :param run: the run, opened and not yet constructed; its libraries are imported by now, or by the end of
        construction
    :param settings: ``real_time_speed`` is how many times as fast as real time robot time may pass
    :param clock: real time in seconds
    :param sleep: waits for so many seconds of it
    """

    def __init__(
        self,
        run: RobotRun,
        settings: Settings,
        clock: Callable[[], float] = _real_clock,
        sleep: Callable[[float], None] = _real_sleep,
    ) -> None:
        self._seconds = PACKET_US / 1_000_000 / settings.test.real_time_speed
        self._run, self._clock, self._sleep = run, clock, sleep
        self._last = -self._seconds
        self._loops = RealTimeLoops()
        self._patches = PatchTable()
        self._watch()
        run.at_close(self._patches.undo)
        run.when_constructed.append(self._on_constructed)

    def _on_constructed(self) -> None:
        if real_time_libraries():
            self._watch()
            self._run.clock.before_packet.append(self._wait)

    def _watch(self) -> None:
        """Intercept calls of the devices, once."""
        if not self._patches:
            for patch in list(self._loops.patches()):  # all are made from the original values
                self._patches.patch(*patch)

    def _wait(self, now: float) -> None:
        if not self._loops.needed or not station.is_enabled():
            self._last = self._clock()
            return
        left = self._last + self._seconds - self._clock()
        if left > 0:
            self._sleep(left)
        self._last = self._clock()
