"""A run as a WPILib data log, for AdvantageScope: each change with its time.

Modes and joysticks have the names of robots' own logs (``DS:enabled``, ``DS:joystick0/axes``), the robot's place is
``/pose``, the output is ``console``, what the robot publishes is under ``NT:``, what was written there from outside is
in `NETWORK_INPUTS`, and everything else has its path in `hal_data`: ``/hal_data/pwm[0].value``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from ....disk_space import check_disk_space
from ....errors import UsageError
from ....runtime.scripts.network_targets import NETWORK_INPUTS
from ....season import CURRENT
from ....wpi import geometry, logs

_DRIVER_STATION = {
    "control.enabled": "DS:enabled",
    "control.autonomous": "DS:autonomous",
    "control.test": "DS:test",
    "control.eStop": "DS:estop",
    "control.opmode": "DS:opMode",
}
#: The interval of flushing WPILib's buffer, in microseconds of robot time: the robot's process may be killed.
_FLUSH_US = 100_000
_STICK = re.compile(r"joysticks\[(\d)\]\.(axes|buttons|povs)")


class WpiLog:
    """Writes one file, from the beginning of a run.

    :raises UsageError: when the file cannot be written
    """

    def __init__(self, file: Path) -> None:
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            if file.is_file() and not file.is_symlink():
                file.unlink()  # another program may be reading it: it keeps what it has opened
            file.write_bytes(b"")
        except OSError as error:
            raise UsageError(f"{file} cannot be written: {error.strerror}", remedy="--wpilog names a file.") from None
        self._file = file
        self._log = logs.LogWriter(file, "pyfrc sim")
        self._stop_network = self._log.network()
        self._inputs = self._log.entry(NETWORK_INPUTS, "text")
        self._console = self._log.entry("console", "text")
        self._entries: dict[str, Any] = {}
        self._pose: Callable[[geometry.Pose2d, int], object] | None = None
        self._flush_us = 0

    def write(
        self,
        now_us: int,
        changed: Mapping[str, object],
        gone: Iterable[str],
        written: Mapping[str, object],
        pose: geometry.Pose2d | None,
    ) -> None:
        """Write the changes at `now_us`, in microseconds of robot time.

        :param written: what dashboards and scripts have written to NetworkTables, by target
        """
        stamp = self._log.stamp(now_us)
        unplugged = {path: () for path in gone if _STICK.fullmatch(path)}  # in robots' logs, it has no controls
        for path, value in {**changed, **unplugged}.items():
            self._entry(path, value)(value, stamp)
        if written:
            self._inputs(json.dumps(dict(written)), stamp)
        if pose is not None:
            if self._pose is None:
                self._pose = self._log.poses("/pose", stamp)
            self._pose(pose, stamp)
        if now_us >= self._flush_us:
            self._flush_us = now_us + _FLUSH_US
            self._log.flush()

    def print(self, now_us: int, line: str) -> None:
        """Write a line of output that was printed at `now_us`, in microseconds of robot time."""
        self._console(line, self._log.stamp(now_us))

    def close(self) -> None:
        """Write what is still in the buffer, and close the file."""
        self._stop_network()
        self._log.flush()
        if check_disk_space(self._file):
            self._log.abandon()
        else:
            self._log.close()

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
                return log.entry(name, "numbers")
            if stick[2] == "povs":
                povs = log.entry(name, "whole numbers")
                return lambda angles, stamp: povs(logs.povs(angles), stamp)
            buttons = log.entry(name, "booleans")
            return lambda pressed, stamp: buttons(pressed[CURRENT.first_button :], stamp)  # WPILib's first is the first
        if isinstance(value, bool):
            return _converting(log.entry(name, "boolean"), bool)
        if isinstance(value, (int, float)):
            return _converting(log.entry(name, "number"), float)
        return _converting(log.entry(name, "text"), str)


def _converting(put: Callable[[Any, int], object], convert: Callable[[Any], Any]) -> Callable[[Any, int], object]:
    """Return a function that appends to an entry. A value of another type, such as None, is left out."""

    def append(value: Any, stamp: int) -> None:
        try:
            converted = convert(value)
        except (TypeError, ValueError):
            return
        put(converted, stamp)

    return append
