"""The least real time that a packet takes while a vendor's library simulates its devices in real time.

Such a device responds after some milliseconds of real time. A run without a limit passes many packets in them: a loop
that is closed in the motor's controller then sees its sensor late, overshoots, and does so differently in each run.
Where no such loop is closed and no device's motion is computed (`RealTimeLoops`), and while the robot is
disabled, nothing waits.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from ..compat.unrepeatable import real_time_libraries
from ..patch_table import Patch, PatchTable
from ..wpi import station
from .robot_time import PACKET_US

if TYPE_CHECKING:
    from ..config.settings import Settings
    from .robot import RobotRun

# As they are before robot time replaces them.
_real_clock, _real_sleep = time.perf_counter, time.sleep

#: The names of phoenix6's control requests for which the motor's controller reads a sensor.
_CLOSED = re.compile(r"Position|Velocity|MotionMagic|Differential(?!.*Follower)")


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


class RealTimeLoops:
    """Whether such devices need real time: where what they do comes back to the robot.

    That is so while a loop is closed in a motor's controller, and once code has asked for the simulation of a device,
    which computes its motion. All else, such as a voltage that the robot's code sets, has no effect that the robot
    could see. The vendor's public functions that begin either are intercepted: nothing else tells.
    """

    def __init__(self) -> None:
        #: The devices whose controllers close a loop, by their identity.
        self._closed: set[int] = set()
        self._is_simulated = False

    @property
    def needed(self) -> bool:
        """Return whether the devices need real time while the robot is enabled."""
        return self._is_simulated or bool(self._closed)

    def patches(self) -> Iterator[Patch]:
        """Return the patches that report to this."""
        hardware: Any = sys.modules.get("phoenix6.hardware")
        for owner in [each for each in vars(hardware).values() if isinstance(each, type)] if hardware else ():
            if hasattr(owner, "set_control"):
                yield Patch(owner, "set_control", self._controlled(owner.set_control))
            if isinstance(simulated := getattr(owner, "sim_state", None), property) and simulated.fget is not None:
                yield Patch(owner, "sim_state", property(self._simulated(simulated.fget)))
        swerve: Any = sys.modules.get("phoenix6.swerve")
        if swerve is not None and hasattr(swerve, "SwerveDrivetrain"):  # its loops are closed in native code
            owner = swerve.SwerveDrivetrain
            yield Patch(owner, "__init__", self._simulated(owner.__init__))

    def _controlled(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def set_control(device: Any, request: Any, *args: Any, **kwargs: Any) -> Any:
            (self._closed.add if _CLOSED.search(type(request).__name__) else self._closed.discard)(id(device))
            return real(device, request, *args, **kwargs)

        return set_control

    def _simulated(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def call(device: Any, *args: Any, **kwargs: Any) -> Any:
            self._is_simulated = True
            return real(device, *args, **kwargs)

        return call
