"""A run as a WPILib data log, for AdvantageScope: each change with its time.

Modes and joysticks have the names of robots' own logs (``DS:enabled``, ``DS:joystick0/axes``), the robot's place is
``/pose``, and everything else has its path in `hal_data`: ``/hal_data/pwm[0].value``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from wpimath.geometry import Pose2d
from wpiutil import DataLogWriter, wpistruct
from wpiutil.log import (
    BooleanArrayLogEntry,
    BooleanLogEntry,
    DoubleArrayLogEntry,
    DoubleLogEntry,
    IntegerArrayLogEntry,
    StringLogEntry,
)

from ....disk_space import check_disk_space
from ....errors import UsageError

_DRIVER_STATION = {
    "control.enabled": "DS:enabled",
    "control.autonomous": "DS:autonomous",
    "control.test": "DS:test",
    "control.eStop": "DS:estop",
}
#: The interval of flushing WPILib's buffer, in microseconds of robot time: the robot's process may be killed.
_FLUSH_US = 100_000
_STICK = re.compile(r"joysticks\[(\d)\]\.(axes|buttons|povs)")

#: Logs that could not be written, kept alive: WPILib aborts the process when it closes such a log.
_UNFINISHED: list[DataLogWriter] = []


class WpiLog:
    """Writes one file, from the beginning of a run.

    :raises UsageError: when the file cannot be written
    """

    def __init__(self, file: Path) -> None:
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            file.write_bytes(b"")
        except OSError as error:
            raise UsageError(f"{file} cannot be written: {error.strerror}", remedy="--wpilog names a file.") from None
        self._file = file
        self._log = DataLogWriter(str(file), "pyfrc sim")
        self._entries: dict[str, Any] = {}
        self._pose: int | None = None
        self._flush_us = 0

    def write(self, now_us: int, changed: Mapping[str, object], pose: Pose2d | None) -> None:
        """Write the changes at `now_us`, in microseconds of robot time."""
        stamp = max(1, now_us)  # to WPILib, 0 is "now"
        for path, value in changed.items():
            self._entry(path, value)(value, stamp)
        if pose is not None:
            # Not by a StructLogEntry, which in WPILib 2026 takes a DataLogWriter for closed ("Object is closed").
            if self._pose is None:
                self._log.addStructSchema(Pose2d, stamp)
                self._pose = self._log.start("/pose", f"struct:{wpistruct.getTypeName(Pose2d)}", "", stamp)
            self._log.appendRaw(self._pose, wpistruct.pack(pose), stamp)
        if now_us >= self._flush_us:
            self._flush_us = now_us + _FLUSH_US
            self._log.flush()

    def close(self) -> None:
        """Write what is still in the buffer, and close the file."""
        self._log.flush()
        if check_disk_space(self._file):
            _UNFINISHED.append(self._log)
        else:
            self._log.stop()

    def _entry(self, path: str, value: object) -> Callable[[Any, int], object]:
        found = self._entries.get(path)
        if found is None:
            found = self._entries[path] = self._new_entry(path, value)
        return found

    def _new_entry(self, path: str, value: Any) -> Callable[[Any, int], object]:
        log = self._log
        name = _DRIVER_STATION.get(path, f"/hal_data/{path}")
        if (stick := _STICK.fullmatch(path)) is not None:
            name = f"DS:joystick{stick[1]}/{stick[2]}"
            if stick[2] == "axes":
                return DoubleArrayLogEntry(log, name).append
            if stick[2] == "povs":
                return IntegerArrayLogEntry(log, name).append
            buttons = BooleanArrayLogEntry(log, name)
            return lambda pressed, stamp: buttons.append(pressed[1:], stamp)  # WPILib's first button is its first
        if isinstance(value, bool):
            return _converting(BooleanLogEntry(log, name), bool)
        if isinstance(value, (int, float)):
            return _converting(DoubleLogEntry(log, name), float)
        return _converting(StringLogEntry(log, name), str)


def _converting(entry: Any, convert: Callable[[Any], Any]) -> Callable[[Any, int], object]:
    """Return a function that appends to an entry. A value of another type, such as None, is left out."""

    def append(value: Any, stamp: int) -> None:
        try:
            converted = convert(value)
        except (TypeError, ValueError):
            return
        entry.append(converted, stamp)

    return append
