"""What `wpilib.sysid.SysIdRoutineLog` writes, in the log of a run.

WPILib's own writes into the log of its C++ code, which a thread completes some time after a run. Names, types and units
of the entries are those that WPILib 2026 writes.
"""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

import wpilib
from wpilib.sysid import SysIdRoutineLog
from wpiutil.log import DataLog, DoubleLogEntry, StringLogEntry

from ....patch_table import Patch


class _Entries:
    """The entries of one routine."""

    def __init__(self, routine: str) -> None:
        self._routine = routine
        self._log: DataLog | None = None
        self._entries: dict[str, Any] = {}

    def append(self, name: str, value: object, kind: type, *metadata: str) -> None:
        """Write a value; the first one of a name makes the entry."""
        log = wpilib.DataLogManager.getLog()
        if log is not self._log:  # that of another run
            self._log, self._entries = log, {}
        name = f"{name}-{self._routine}"
        if name not in self._entries:
            self._entries[name] = kind(log, name, *metadata)
        self._entries[name].append(value)


class MotorLog:
    """Logs the data of one motor, as WPILib's `SysIdRoutineLog.MotorLog`; each method returns this object."""

    def __init__(self, entries: _Entries, name: str) -> None:
        self._entries, self._name = entries, name

    def value(self, name: str, value: float, unit: str) -> MotorLog:
        """Log any value of the motor."""
        self._entries.append(f"{name}-{self._name}", float(value), DoubleLogEntry, unit)
        return self

    def voltage(self, voltage: float) -> MotorLog:
        """Log the voltage, in volts."""
        return self.value("voltage", voltage, "volt")

    def current(self, current: float) -> MotorLog:
        """Log the current, in amperes."""
        return self.value("current", current, "ampere")

    def position(self, position: float) -> MotorLog:
        """Log the position, in metres."""
        return self.value("position", position, "meter")

    def velocity(self, velocity: float) -> MotorLog:
        """Log the velocity, in metres per second."""
        return self.value("velocity", velocity, "meters_per_second")

    def acceleration(self, acceleration: float) -> MotorLog:
        """Log the acceleration, in metres per second squared."""
        return self.value("acceleration", acceleration, "meters_per_second_squared")

    def angularPosition(self, position: float) -> MotorLog:
        """Log the angle, in turns."""
        return self.value("position", position, "turn")

    def angularVelocity(self, velocity: float) -> MotorLog:
        """Log the angular velocity, in turns per second."""
        return self.value("velocity", velocity, "turns_per_second")

    def angularAcceleration(self, acceleration: float) -> MotorLog:
        """Log the angular acceleration, in turns per second squared."""
        return self.value("acceleration", acceleration, "turns_per_second_squared")


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""
    routines: WeakKeyDictionary[Any, _Entries] = WeakKeyDictionary()
    real = SysIdRoutineLog.__init__

    def initialize(self: Any, logName: str) -> None:
        real(self, logName)
        routines[self] = _Entries(logName)

    def motor(self: Any, motorName: str) -> MotorLog:
        return MotorLog(routines[self], motorName)

    def record_state(self: Any, state: Any) -> None:
        routines[self].append("sysid-test-state", SysIdRoutineLog.stateEnumToString(state), StringLogEntry)

    return [
        Patch(SysIdRoutineLog, "__init__", initialize),
        Patch(SysIdRoutineLog, "motor", motor),
        Patch(SysIdRoutineLog, "recordState", record_state),
    ]
