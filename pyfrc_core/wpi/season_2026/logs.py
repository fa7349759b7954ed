"""Data logs: those of robots are read, those of simulations are written."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Literal

import ntcore
from wpimath.geometry import Pose2d
from wpiutil import DataLogWriter, wpistruct
from wpiutil.log import (
    BooleanArrayLogEntry,
    BooleanLogEntry,
    DoubleArrayLogEntry,
    DoubleLogEntry,
    IntegerArrayLogEntry,
)
from wpiutil.log import DataLog as DataLog
from wpiutil.log import IntegerLogEntry as IntegerLogEntry
from wpiutil.log import StringLogEntry as StringLogEntry

from ...log_records import Record

#: WPILib's own writer, whose name is replaced for robot code.
RealWriter = DataLogWriter

Kind = Literal["boolean", "number", "text", "booleans", "numbers", "whole numbers"]

_ENTRIES: dict[Kind, Any] = {
    "boolean": BooleanLogEntry,
    "number": DoubleLogEntry,
    "text": StringLogEntry,
    "booleans": BooleanArrayLogEntry,
    "numbers": DoubleArrayLogEntry,
    "whole numbers": IntegerArrayLogEntry,
}


#: What has a robot log the data of a driver station.
HOW_TO_LOG_STATION = "In robotInit, wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog()) logs it."


def povs(angles: list[int]) -> list[int]:
    """Return the values of POVs as a log has them, from angles in degrees."""
    return angles


def as_in_2026(record: Record) -> Iterable[Record]:
    """Return what a record is in logs of 2026."""
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
        """Return the log's number for a time, from microseconds of robot time."""
        return max(1, now_us)  # to WPILib, 0 is "now"

    def entry(self, name: str, kind: Kind) -> Callable[[Any, int], object]:
        """Add an entry, and return what appends a value to it, with the value's time."""
        append: Callable[[Any, int], object] = _ENTRIES[kind](self._log, name).append
        return append

    def poses(self, name: str, stamp: int) -> Callable[[Pose2d, int], object]:
        """Add an entry for poses, and return what appends one to it, with its time."""
        # Not by a StructLogEntry, which in WPILib 2026 takes a DataLogWriter for closed ("Object is closed").
        log = self._log
        log.addStructSchema(Pose2d, stamp)
        entry = log.start(name, f"struct:{wpistruct.getTypeName(Pose2d)}", "", stamp)
        return lambda pose, stamp: log.appendRaw(entry, wpistruct.pack(pose), stamp)

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
    tables = ntcore.NetworkTableInstance.getDefault()
    entries = tables.startEntryDataLog(log, "", "NT:")
    connections = tables.startConnectionDataLog(log, "NTConnection")

    def stop() -> None:
        tables.stopEntryDataLog(entries)
        tables.stopConnectionDataLog(connections)

    return stop
