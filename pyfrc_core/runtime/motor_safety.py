"""WPILib's motor safety, checked in robot time.

WPILib checks from a C++ thread of its own, in wall time: at our speed it would find a motor "not updated often
enough" whenever the machine happens to be busy between two of its instructions. Here a motor whose safety is on is
switched off in WPILib's eyes except for the instant in which this module has it checked, on every fourth packet while
the robot is enabled, as that thread does on a robot.
"""

from __future__ import annotations

import weakref
from typing import Any

import wpilib
import wpilib.drive
from hal.simulation import getDriverStationDsAttached, getDriverStationEnabled
from wpilib import MotorSafety

_PACKETS_BETWEEN_CHECKS = 4

# WPILib's drives come with their safety on; everything else is switched on by name.
BORN_SAFE = (wpilib.drive.DifferentialDrive, wpilib.drive.MecanumDrive)

switch_in_wpilib = MotorSafety.setSafetyEnabled


class MotorSafetyWatch:
    """The motors whose safety is on, and the count of packets since they were last checked."""

    def __init__(self) -> None:
        self._guarded: dict[int, weakref.ref[MotorSafety]] = {}
        self._packets = 0

    def set_enabled(self, motor: MotorSafety, enabled: bool) -> None:
        key = id(motor)
        if enabled:
            self._guarded[key] = weakref.ref(motor, lambda _: self._guarded.pop(key, None))
        else:
            self._guarded.pop(key, None)
        switch_in_wpilib(motor, False)

    def is_enabled(self, motor: MotorSafety) -> bool:
        return id(motor) in self._guarded

    def is_alive(self, motor: MotorSafety) -> bool:
        """Whether the motor was fed within its expiration time (or need not be)."""
        if not self.is_enabled(motor):
            return True
        return bool(self._as_guarded(motor, motor_is_alive))

    def on_packet(self) -> None:
        """Stop, with WPILib's own message, each motor that was not fed in time."""
        if not self._guarded:
            return
        if not (getDriverStationEnabled() and getDriverStationDsAttached()):
            self._packets = 0
            return
        self._packets += 1
        if self._packets < _PACKETS_BETWEEN_CHECKS:
            return
        self._packets = 0
        for reference in list(self._guarded.values()):
            motor = reference()
            if motor is not None:
                self._as_guarded(motor, motor_check)

    @staticmethod
    def _as_guarded(motor: MotorSafety, question: Any) -> Any:
        switch_in_wpilib(motor, True)
        try:
            return question(motor)
        finally:
            switch_in_wpilib(motor, False)


motor_is_alive = MotorSafety.isAlive
motor_check = MotorSafety.check
