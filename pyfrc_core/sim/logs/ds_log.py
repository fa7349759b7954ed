"""The driver station's own logs, versions 3 and 4: ``.dslog``, a record each 20 ms; ``.dsevents``, what it showed.

NI has not published the formats. They are known from what people have found out: frcture.readthedocs.io, and the thread
"Version 4 of dsevent/dslog?" on Chief Delphi. Numbers are big-endian; times are seconds since 1904 and a fraction.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator
from datetime import datetime, timedelta, timezone
from pathlib import Path
from struct import Struct
from typing import Any, NamedTuple

from ..engine.past_run import Happened
from ..engine.value_history import MISSING
from .columns import Column, ReadLog

_VERSIONS = (3, 4)
_EPOCH = datetime(1904, 1, 1, tzinfo=timezone.utc)
_HEADER, _TIME, _RECORD = Struct(">iqQ"), Struct(">qQi"), Struct(">BbHBBBBH")
_PERIOD_US = 20_000
#: The kinds of power distribution, and the bytes that each record has of them. From version 4 on, four bytes before
#: them name the kind; before that, it is always that of CTRE.
_REV, _CTRE = 33, 25
_SIZES, _KIND_BYTES = {_REV: 33, _CTRE: 25}, 4
#: More volts than a battery can have: there is no data, which is 0xFFFF, or a record is wrong, as the last one may be.
_MOST_VOLTS = 20.0
#: Whether the robot has said its mode, in the packet of each record.
CONNECTED = "/DSLog/Connected"
_STATUS = {
    "Brownout": 7,
    "Watchdog": 6,
    "DSTeleop": 5,
    "DSDisabled": 3,
    "RobotTeleop": 2,
    "RobotAuto": 1,
    "RobotDisabled": 0,
}
#: The parts of an event that are no text for people.
_TAG = re.compile(r"<(TagVersion|time|count|flags|Code|location|stack)>[^<]*")
_PLAIN_TAG = re.compile(r"<(message|details)> ?")
#: Where one of several messages in an event begins.
_BEGIN = re.compile("(?=<TagVersion>)")
_LONGEST_EVENT = 1 << 20


def read_ds_log(file: Path) -> ReadLog:
    """Read the log ``NAME.dslog``."""
    data = file.read_bytes()
    version, when = _header(data)
    if version not in _VERSIONS:
        return _of_another_version(version)
    found = ReadLog(when=when)
    records = list(_records(data, found, version))
    moments = array("q", range(0, _PERIOD_US * len(records), _PERIOD_US))
    rows = [_numbers(record) for record in records]
    if not rows:
        return found
    columns: dict[str, list[Any]] = {name: [row[name] for row in rows] for name in rows[0]}
    _hold_modes(columns)
    channels = max(len(record.currents) for record in records)
    for channel in range(channels):
        columns[f"Currents/{channel}"] = [
            record.currents[channel] if channel < len(record.currents) else MISSING for record in records
        ]
    for name, values in columns.items():
        found.columns[f"/DSLog/{name}"] = Column.of(moments, values)
        found.types[f"/DSLog/{name}"] = "boolean" if isinstance(values[0], bool) else "double"
    return found


def read_ds_events(file: Path) -> ReadLog:
    """Read the events ``NAME.dsevents``."""
    data = file.read_bytes()
    version, when = _header(data)
    if version not in _VERSIONS:
        return _of_another_version(version)
    found, place = ReadLog(when=when), _HEADER.size
    begin = _seconds(*_HEADER.unpack_from(data)[1:])
    while place < len(data):
        if place + _TIME.size > len(data):
            found.problem = f"it is cut at byte {place:,}"
            break
        seconds, fraction, length = _TIME.unpack_from(data, place)
        after = place + _TIME.size + length
        if not 0 <= length <= _LONGEST_EVENT or after > len(data):
            found.problem = f"it is {'cut' if 0 <= length <= _LONGEST_EVENT else 'damaged'} at byte {place:,}"
            break
        at = max(_seconds(seconds, fraction) - begin, 0.0)
        event = data[place + _TIME.size : after].decode("utf-8", "replace")
        texts = filter(None, map(_plain, _BEGIN.split(event)))
        found.happened += [Happened(at, "", text, is_mark=True) for text in texts]
        place = after
    return found


def _of_another_version(version: int) -> ReadLog:
    return ReadLog(problem=f"it has version {version} of the driver station's format; versions 3 and 4 can be read")


def _plain(text: str) -> str:
    """Return an event as people read it."""
    return re.sub(r"[ \t]{2,}", "  ", _PLAIN_TAG.sub("", _TAG.sub("", text))).strip()


def _header(data: bytes) -> tuple[int, datetime | None]:
    if len(data) < _HEADER.size:
        return 0, None
    version, seconds, fraction = _HEADER.unpack_from(data)
    try:
        return version, _EPOCH + timedelta(seconds=_seconds(seconds, fraction))
    except OverflowError:
        return version, None


def _seconds(seconds: int, fraction: int) -> float:
    return float(seconds) + fraction / 2**64


class _Record(NamedTuple):
    trip: int
    loss: int
    volts: int
    cpu: int
    status: int
    can: int
    signal: int
    bandwidth: int
    currents: tuple[float, ...]


def _records(data: bytes, log: ReadLog, version: int) -> Iterator[_Record]:
    place, kind_bytes = _HEADER.size, _KIND_BYTES if version > _VERSIONS[0] else 0
    while place < len(data):
        begin = place + _RECORD.size + kind_bytes
        kind = data[begin - 1] if kind_bytes and begin <= len(data) else _CTRE
        after = begin + _SIZES.get(kind, 0)
        if after > len(data):
            log.problem = f"it is cut at byte {place:,}, within a record"
            return
        values = _RECORD.unpack_from(data, place)
        yield _Record._make((*values, _currents(kind, data[begin + 1 : after])))
        place = after


def _currents(kind: int, data: bytes) -> tuple[float, ...]:
    """Return the current of each channel, in A."""
    if kind == _REV:  # three channels of 10 bits in 32, and four channels of a byte
        bits = int.from_bytes(data, "little")
        first = (((bits >> channel // 3 * 32 + channel % 3 * 10) & 1023) / 8 for channel in range(20))
        return (*first, *(data[27 + channel] / 16 for channel in range(4)))
    if kind == _CTRE:  # six channels of 10 bits in 64, the first in the highest bits
        bits = int.from_bytes(data[:21], "big")
        return tuple(((bits >> 158 - channel // 6 * 64 - channel % 6 * 10) & 1023) / 8 for channel in range(16))
    return ()


def _numbers(record: _Record) -> dict[str, Any]:
    """Return what a record says, by name: ms, V and shares from 0 to 1; `MISSING` for what it does not have."""
    status, volts = {name: not record.status >> bit & 1 for name, bit in _STATUS.items()}, record.volts / 256
    return {
        "TripTime": record.trip * 0.5,
        "PacketLoss": min(max(record.loss * 0.04, 0.0), 1.0),
        "BatteryVoltage": volts if volts <= _MOST_VOLTS else MISSING,
        "CPUUtilization": record.cpu * 0.005,
        "CANUtilization": record.can * 0.005,
        **status,
        "Enabled": status["RobotTeleop"] or status["RobotAuto"],
        "Autonomous": status["RobotAuto"],
    }


def _hold_modes(columns: dict[str, list[Any]]) -> None:
    """Keep the mode in records in which the robot has said none, since its packet was lost."""
    said = zip(*(columns[name] for name in ("RobotDisabled", "RobotTeleop", "RobotAuto")), strict=True)
    connected = list(map(any, said))
    columns[CONNECTED.rpartition("/")[2]] = connected
    for number, is_connected in enumerate(connected):
        if number and not is_connected:
            for name in ("Enabled", "Autonomous"):
                columns[name][number] = columns[name][number - 1]
