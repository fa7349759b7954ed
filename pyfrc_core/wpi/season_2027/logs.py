"""Data logs: those of robots are read, those of simulations are written."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Literal

import hal
import ntcore
from wpilog import (
    BooleanArrayLogEntry,
    BooleanLogEntry,
    DataLogWriter,
    DoubleArrayLogEntry,
    DoubleLogEntry,
    IntegerArrayLogEntry,
)
from wpilog import DataLog as DataLog
from wpilog import IntegerLogEntry as IntegerLogEntry
from wpilog import StringLogEntry as StringLogEntry
from wpimath import Pose2d
from wpiutil import wpistruct

from ...log_records import Record
from . import timing
from .station import angle_of, pov_of

#: WPILib's own writer, whose name is replaced for robot code.
RealWriter = DataLogWriter

#: What the word of the driver station is in a log of 2026, which has no such word, and in one of ours.
_OF_CONTROL_WORD: dict[str, Callable[[hal.ControlWord], bool]] = {
    "DS:enabled": hal.ControlWord.is_enabled,
    "DS:autonomous": hal.ControlWord.is_autonomous,
    "DS:test": hal.ControlWord.is_utility,
    "DS:estop": hal.ControlWord.is_e_stopped,
    "/hal_data/control.dsAttached": hal.ControlWord.is_ds_attached,
    "/hal_data/control.fmsAttached": hal.ControlWord.is_fms_attached,
}
_TABLE = "NT:/DriverStation/"
#: The names of 2027's entries, and those of 2026 for the same, or the ones of a log of ours.
_AS_IN_2026 = {
    "DS:opMode": "/hal_data/control.opmode",
    f"{_TABLE}GameData": "NT:/FMSInfo/GameSpecificMessage",
    **{
        f"{_TABLE}{name}": f"NT:/FMSInfo/{name}"
        for name in ("EventName", "MatchNumber", "MatchType", "ReplayNumber", "IsRedAlliance", "StationNumber")
    },
}
_POVS = re.compile(r"DS:joystick\d/povs")

#: What has a robot log the data of a driver station.
HOW_TO_LOG_STATION = (
    "In the robot's __init__, wpilib.DriverStation.start_data_log(wpilib.DataLogManager.get_log()) logs it."
)


Kind = Literal["boolean", "number", "text", "booleans", "numbers", "whole numbers"]

_ENTRIES: dict[Kind, Any] = {
    "boolean": BooleanLogEntry,
    "number": DoubleLogEntry,
    "text": StringLogEntry,
    "booleans": BooleanArrayLogEntry,
    "numbers": DoubleArrayLogEntry,
    "whole numbers": IntegerArrayLogEntry,
}


def povs(angles: list[int]) -> list[int]:
    """Return the values of POVs as a log has them, from angles in degrees."""
    return [int(pov_of(angle)) for angle in angles]


def as_in_2026(record: Record) -> Iterable[Record]:
    """Return what a record is in logs of 2026, or in one of ours."""
    record = record._replace(name=_AS_IN_2026.get(record.name, record.name))
    if record.name == "DS:controlWord":
        if not isinstance(record.value, bytes) or len(record.value) != wpistruct.get_size(hal.ControlWord):
            return ()  # an entry of the team's own
        word = wpistruct.unpack(hal.ControlWord, record.value)
        return (Record(record.at_us, name, "boolean", get(word)) for name, get in _OF_CONTROL_WORD.items())
    if _POVS.fullmatch(record.name):
        directions = record.value if isinstance(record.value, tuple) else ()
        return (record._replace(value=[*map(angle_of, directions)]),)
    return (record,)


#: Logs that could not be written, kept alive: WPILib aborts the process when it closes such a log.
_UNFINISHED: list[DataLogWriter] = []


class LogWriter:
    """Writes a log. Its times are those that `stamp` returns.

    :param file: must be writable
    :param writer: the name of the program that writes it
    """

    def __init__(self, file: Path, writer: str) -> None:
        self._log = DataLogWriter(str(file), writer)

    @staticmethod
    def stamp(now_us: int) -> int:
        """Return the log's number for a time, from microseconds of robot time: that of NetworkTables, the HAL's."""
        return timing.hal_time(now_us)

    def entry(self, name: str, kind: Kind) -> Callable[[Any, int], object]:
        """Add an entry, and return what appends a value to it, with the value's time."""
        append: Callable[[Any, int], object] = _ENTRIES[kind](self._log, name).append
        return append

    def poses(self, name: str, stamp: int) -> Callable[[Pose2d, int], object]:
        """Add an entry for poses, and return what appends one to it, with its time."""
        # Not by a StructLogEntry, which in WPILib 2026 takes a DataLogWriter for closed ("Object is closed").
        log = self._log
        log.add_struct_schema(Pose2d, stamp)
        entry = log.start(name, f"struct:{wpistruct.get_type_name(Pose2d)}", "", stamp)
        return lambda pose, stamp: log.append_raw(entry, wpistruct.pack(pose), stamp)

    def network(self) -> Callable[[], None]:
        """Log all changes of NetworkTables, until the function that is returned is called, before `close`."""
        return log_network(self._log)

    def flush(self) -> None:
        """Write WPILib's buffer to the file."""
        self._log.flush()

    def close(self) -> None:
        """Close the file."""
        self._log.stop()

    def abandon(self) -> None:
        """Leave a file as it is that could not be written."""
        _UNFINISHED.append(self._log)


def log_network(log: DataLog) -> Callable[[], None]:
    """Log all changes of NetworkTables, from now on until the function that is returned is called."""
    tables = ntcore.NetworkTableInstance.get_default()
    entries = tables.start_entry_data_log(log, "", "NT:")
    connections = tables.start_connection_data_log(log, "NTConnection")

    def stop() -> None:
        tables.stop_entry_data_log(entries)
        tables.stop_connection_data_log(connections)

    return stop
