"""What a value of `hal_data` is, by its path: its row in the device table. Asking needs no WPILib."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from typing import NamedTuple

from . import accessors, device_table
from .fields import DeviceField, DeviceKind, Role
from .kinds import WrongPath
from .paths import join, parse_path

#: The names of what SimDevices measure, and of settings and outputs with similar names.
_OF_DEVICES = re.compile(
    r"position|velocity|angle|angular|rotation|yaw|pitch|roll|rate|accel|range|distance|pressed|connected|valid"
    r"|current|voltage|temperature|[xyz]$",
    re.IGNORECASE,
)
_SETTINGS = re.compile(r"factor|offset|set.?point|limit|\bterm\b|\bm(?:ax|in)\b|units|mode|init", re.IGNORECASE)
#: The names of what robot code asks a motor controller for.
_COMMANDS = re.compile("applied output|set.?point|duty", re.IGNORECASE)


class TableRow(NamedTuple):
    """One value in the device table, of all devices of its kind."""

    kind: DeviceKind
    field: DeviceField

    @property
    def stays(self) -> bool:
        """Whether a restart of the robot program leaves it."""
        return self.kind.stays if self.field.stays is None else self.field.stays

    @property
    def asked_by(self) -> str:
        """The function with which robot code asks for it, if it is varied only for code that does; else empty."""
        return self.field.asked_by and accessors.getter_name(self.field.asked_by)


@cache
def _rows() -> dict[tuple[str, ...], TableRow]:
    """Return all rows, by the names in their paths, without numbers."""
    return {
        tuple(filter(None, (kind.name, field.name))): TableRow(kind, field)
        for kind in device_table.KINDS
        for field in kind.fields
    }


def all_rows() -> Iterator[TableRow]:
    """Return all rows."""
    return iter(_rows().values())


def rows_of(kind: DeviceKind) -> Iterator[TableRow]:
    """Return the rows of one kind of device."""
    return (TableRow(kind, field) for field in kind.fields)


@cache
def gyros(numbered: bool) -> tuple[TableRow, ...]:
    """Return the values that turn with the robot: of gyros at channels of the controller, or of its own ones."""
    turning = (row for row in all_rows() if row.field.heading or row.field.turning)
    return tuple(row for row in turning if (row.kind.count is not None) == numbered)


@lru_cache(maxsize=4096)
def row_of(path: str) -> TableRow | None:
    """Return the row of a value; None for a value that robot code makes up, and for what is no path."""
    try:
        names = tuple(segment for segment in parse_path(path) if isinstance(segment, str))
    except WrongPath:
        return None
    return _rows().get(names)


@cache
def _kinds() -> dict[str, DeviceKind]:
    return {kind.name: kind for kind in device_table.KINDS if kind.name}


def kind_of(path: str) -> DeviceKind | None:
    """Return the kind of device that a value is of; None for a value that robot code makes up, and for no path."""
    try:
        return _kinds().get(str(parse_path(path)[0]))
    except WrongPath:
        return None


def made_by_robot(path: str) -> bool:
    """Return whether the value comes with what robot code makes, by a name or number that it chooses."""
    kind = kind_of(path)
    return kind.by_number if kind is not None else str(parse_path(path)[0]) in ("CAN", "robot", "custom")


def stays(path: str) -> bool:
    """Return whether a restart of the robot program leaves what was written to a path."""
    if (row := row_of(path)) is not None:
        return row.stays
    kind = kind_of(path)
    return kind is not None and kind.stays


def role_of(path: str) -> Role:
    """Return whether robot code reads or sets a value; SimDevices have no rows, so the names of their values decide."""
    if (row := row_of(path)) is not None:
        return row.field.role
    if not path.startswith("CAN["):
        return ""
    name = str(parse_path(path)[-1])
    if _OF_DEVICES.search(name) and not _SETTINGS.search(name):
        return "measured"
    return "output" if _COMMANDS.search(name) else ""


def is_input(path: str, values: Mapping[str, object]) -> bool:
    """Return whether a measured value's channel is an input: a digital one can be an output, too.

    :param values: the values by path
    """
    row = row_of(path)
    return row is None or not row.field.only_if or bool(values.get(beside(path, row.field.only_if), True))


def decides(path: str) -> bool:
    """Return whether a value says of another one of its device whether it is measured, or an output."""
    row = row_of(path)
    return row is not None and any(field.only_if == row.field.name for field in row.kind.fields)


def beside(path: str, key: str) -> str:
    """Return the path of another value of the same device."""
    return join(path.rpartition(".")[0], key)
