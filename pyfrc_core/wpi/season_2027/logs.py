"""Data logs: those of robots are read, those of simulations are written."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple

import hal
import ntcore
from wpilog import (
    BooleanArrayLogEntry,
    BooleanLogEntry,
    DataLog,
    DataLogReader,
    DataLogRecord,
    DataLogWriter,
    DoubleArrayLogEntry,
    DoubleLogEntry,
    IntegerArrayLogEntry,
    IntegerLogEntry,
    StringLogEntry,
)
from wpimath import Pose2d
from wpiutil import wpistruct

from . import timing
from .station import angle_of, pov_of

__all__ = [
    "HOW_TO_LOG_STATION",
    "MALFORMED",
    "DataLog",
    "IntegerLogEntry",
    "Kind",
    "LogWriter",
    "RealWriter",
    "Record",
    "StringLogEntry",
    "log_network",
    "povs",
    "records",
]

#: WPILib's own writer, whose name is replaced for robot code.
RealWriter = DataLogWriter

_CONTROL_WORD = "struct:ControlWord"

_READ: dict[str, Callable[[DataLogRecord], Any]] = {
    "boolean": DataLogRecord.get_boolean,
    "double": DataLogRecord.get_double,
    "float": DataLogRecord.get_float,
    "int64": DataLogRecord.get_integer,
    "string": DataLogRecord.get_string,
    "string[]": DataLogRecord.get_string_array,
    "boolean[]": DataLogRecord.get_boolean_array,
    "double[]": DataLogRecord.get_double_array,
    "float[]": DataLogRecord.get_float_array,
    "int64[]": DataLogRecord.get_integer_array,
    _CONTROL_WORD: lambda record: wpistruct.unpack(hal.ControlWord, bytes(record.get_raw())),
}

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


def _data(record: DataLogRecord) -> bytes:
    return bytes(record.get_raw())


#: What `records` raises if a log is malformed.
MALFORMED = (RuntimeError, ValueError, TypeError, IndexError, OSError)

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


class Record(NamedTuple):
    """A value in a log.

    :param at_us: when it was logged, in microseconds of the robot's clock; in a simulation, of robot time
    :param type_name: the name of its type in the log, such as ``int64``
    """

    at_us: int
    name: str
    type_name: str
    value: Any


def records(file: Path, beginnings: tuple[str, ...], of_data: tuple[str, ...] = ()) -> Iterator[Record] | None:
    """Return the plain values in a log, in the order of the file; None if this is no data log.

    :param beginnings: of the names whose values are wanted
    :param of_data: of those of which other values are wanted, too, as bytes
    :raises MALFORMED: when iterated over
    """
    reader = DataLogReader(str(file))
    return _records(reader, beginnings, of_data) if reader.is_valid() else None


def _records(reader: DataLogReader, beginnings: tuple[str, ...], of_data: tuple[str, ...]) -> Iterator[Record]:
    entries: dict[int, tuple[str, str]] = {}
    for record in reader:
        if record.is_start():
            start = record.get_start_data()
            if start.name.startswith(beginnings if start.type in _READ else of_data):
                entries[start.entry] = _AS_IN_2026.get(start.name, start.name), start.type
        elif not record.is_control() and record.get_entry() in entries:
            name, type_name = entries[record.get_entry()]
            read: Callable[[DataLogRecord], Any] = _READ.get(type_name, _data)
            at_us, value = record.get_timestamp() % timing.ROUND // 1_000, read(record)
            if name == "DS:controlWord":
                yield from (Record(at_us, part, "boolean", get(value)) for part, get in _OF_CONTROL_WORD.items())
            else:
                yield Record(at_us, name, type_name, list(map(angle_of, value)) if _POVS.fullmatch(name) else value)


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
