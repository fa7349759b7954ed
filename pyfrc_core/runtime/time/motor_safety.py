"""Check WPILib's motor safety in robot time.

WPILib checks it on a C++ thread that every driver-station packet wakes, in wall time. At our speed it would find a
motor "not updated often enough" whenever the machine is busy between two of the thread's instructions. So that thread
is unsubscribed from packets, and WPILib's check is called here: on every fourth packet while the robot is enabled, as
the thread does on a robot.
"""

from __future__ import annotations

from ...wpi import station, watchdogs

_PACKETS_BETWEEN_CHECKS = 4


class MotorSafetyCheck:
    """Counts packets from one check of the motors to the next. WPILib's thread gets no packets from now on."""

    def __init__(self) -> None:
        self._packets = 0
        watchdogs.unsubscribe_motor_safety()

    def on_packet(self, now: float) -> None:
        """Stop, with WPILib's own message, each motor that was not fed in time."""
        enabled = station.sends_enabled() and station.is_attached()
        # Counted as WPILib does: a robot that has just been enabled has three packets to feed its motors.
        self._packets = self._packets + 1 if enabled else 1
        if enabled and self._packets >= _PACKETS_BETWEEN_CHECKS:
            self._packets = 0
            watchdogs.check_motors()
