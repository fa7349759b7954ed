"""WPILib's motor safety, checked in robot time.

WPILib checks from a C++ thread that every driver-station packet wakes, in wall time: at our speed it would find a motor
"not updated often enough" whenever the machine happens to be busy between two of its instructions, and waking it costs
about as much as the robot's whole loop. So that thread is made deaf to packets, and its check, WPILib's own, is made
here: on every fourth packet while the robot is enabled, as that thread does on a robot.
"""

from __future__ import annotations

import time
from functools import cache

import hal
import wpilib
from hal.simulation import getDriverStationDsAttached, getDriverStationEnabled
from wpiutil.sync import createEvent, destroyEvent

_PACKETS_BETWEEN_CHECKS = 4

# WPILib's handles of events: this and an index, which counts on with each event that is made.
_FIRST_EVENT = 0x0100_0000
_EVENTS_AT_IMPORT = 64

# How often to look whether the thread has made its event, and for how long, in wall seconds: it has almost at once;
# never, if it was there before.
_LOOK_SECONDS, _PATIENCE = 0.0001, 0.05

_wait, _wall = time.sleep, time.monotonic


class _AnyMotor(wpilib.MotorSafety):
    """The first motor starts the thread."""

    def stopMotor(self) -> None:
        """There is nothing to stop."""

    def getDescription(self) -> str:
        return "none"


class MotorSafetyCheck:
    """The count of packets since motors were last checked, and the events of which WPILib's thread must not hear."""

    def __init__(self) -> None:
        self._packets = 0
        # Of a thread that a motor made at import has started, the event is one of these.
        for index in range(_EVENTS_AT_IMPORT):
            hal.removeNewDataEventHandle(_FIRST_EVENT + index)
        self._events = _start_its_thread()

    def on_packet(self, now: float) -> None:
        """Stop, with WPILib's own message, each motor that was not fed in time."""
        enabled = getDriverStationEnabled() and getDriverStationDsAttached()
        # Counted as WPILib does: a robot that has just been enabled has three packets to feed its motors.
        self._packets = self._packets + 1 if enabled else 1
        if enabled and self._packets < _PACKETS_BETWEEN_CHECKS:
            return
        # Again and again, since the thread subscribes to packets when it gets to it.
        for event in self._events:
            hal.removeNewDataEventHandle(event)
        if enabled:
            self._packets = 0
            wpilib.MotorSafety.checkMotors()


@cache
def _start_its_thread() -> tuple[int, ...]:
    """Start WPILib's thread, of which a process has one; answers its event: what was made between two of ours."""
    ours = [createEvent(False, False)]
    motor = _AnyMotor()
    give_up = _wall() + _PATIENCE
    between: tuple[int, ...] = ()
    while not between and _wall() < give_up:
        _wait(_LOOK_SECONDS)
        ours.append(createEvent(False, False))
        between = tuple(range(ours[-2] + 1, ours[-1]))
    del motor
    for event in ours:
        destroyEvent(event)
    return between
