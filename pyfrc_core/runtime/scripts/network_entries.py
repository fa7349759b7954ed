"""Writes entries of NetworkTables for input scripts, by their targets (`network_targets`)."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from typing import Any

from ...errors import UsageError
from ...wpi import network
from .network_targets import DATA, STRUCT, parse_entry_target

#: What cameras send for a pose that they could not compute.
NOT_A_NUMBER = "nan"

_DOUBLES = ("float[]", "double[]")

#: Writes a value to one entry, with its time in microseconds; None: now.
_Writer = Callable[[Any, "int | None"], None]


class NetworkEntries:
    """Writes to entries of NetworkTables, until it is closed."""

    def __init__(self) -> None:
        self._writers: dict[str, _Writer] = {}
        self._unpublish: list[Callable[[], object]] = []

    def write(self, target: str, value: object, at_us: int | None = None) -> None:
        """Write one value.

        :param at_us: the time that it gets in NetworkTables, in microseconds of robot time; None: now
        :raises UsageError: when the entry cannot have this value
        """
        writer = self._writers.get(target)
        if writer is None:
            writer = self._writers[target] = _writer(*parse_entry_target(target), self._unpublish.append)
        writer(value, at_us)

    def close(self) -> None:
        """Unpublish what was written.

        In a later run in this process, NetworkTables would take these values for newer than all that is written then.
        """
        for unpublish in self._unpublish:
            unpublish()
        self._writers.clear()
        self._unpublish.clear()


def _writer(name: str, type_name: str, at_end: Callable[[Callable[[], object]], object]) -> _Writer:
    """Return what writes an entry.

    :param at_end: is given what unpublishes it
    """
    if type_name.startswith(STRUCT):
        structs = network.DataEntry(name, type_name)
        at_end(structs.unpublish)

        def write_struct(value: Sequence[float], at_us: int | None) -> None:
            try:
                structs.write(struct.pack(f"<{len(value)}d", *map(_number, value)), at_us)
            except (TypeError, struct.error):
                raise UsageError(f"{name} is a struct, written as a list of its numbers, not {value!r}") from None

        return write_struct
    if type_name.startswith(DATA):
        data = network.DataEntry(name, type_name.removeprefix(DATA).removesuffix(")"))
        at_end(data.unpublish)

        def write_data(value: str, at_us: int | None) -> None:
            try:
                data.write(bytes.fromhex(value), at_us)
            except (TypeError, ValueError):
                raise UsageError(f"{name} has bytes, written as hexadecimal digits, not {value!r}") from None

        return write_data
    entry = network.Entry(name)
    at_end(entry.unpublish)
    if not type_name:
        return lambda value, at_us: _write_plain(entry, value, at_us)
    if type_name not in network.TYPES:
        types = ", ".join(network.TYPES)
        raise UsageError(f"NetworkTables has no type {type_name!r}: the types are {types}, struct:NAME")

    def write_typed(value: Any, at_us: int | None) -> None:
        try:
            is_list = isinstance(value, list | tuple)
            made = [_number(each) if type_name in _DOUBLES else each for each in value] if is_list else value
            fits = entry.write(made, type_name, at_us)
        except TypeError:
            raise UsageError(f"{name} is {type_name}, and cannot be {value!r}") from None
        if not fits:
            raise _wrong(entry, value)

    return write_typed


def _number(value: Any) -> Any:
    return math.nan if value == NOT_A_NUMBER else value


def _write_plain(entry: network.Entry, value: Any, at_us: int | None) -> None:
    """Write numbers as the type that the entry has, and as doubles where it has none; other values as they are.

    JSON does not tell 1 from 1.0, and dashboards write doubles.
    """
    is_list = isinstance(value, list | tuple)
    made = list(value) if is_list else value
    items = made if is_list else [made]
    kind = ""
    try:
        if all(isinstance(each, int | float) and not isinstance(each, bool) for each in items):
            brackets = "[]" if is_list else ""
            # An empty list is one of any type.
            of_entry = entry.type_name
            fits = of_entry in network.TYPES if not items else of_entry in (f"int{brackets}", f"float{brackets}")
            kind = of_entry if fits else f"double{brackets}"
        fits = entry.write(made, kind, at_us)
    except (TypeError, ValueError, RuntimeError):  # 0.5 in an int[], a list of several kinds, a list of lists
        raise _wrong(entry, value) from None
    if not fits:
        raise _wrong(entry, value)


def _wrong(entry: network.Entry, value: Any) -> UsageError:
    type_name = entry.type_name
    return UsageError(f"{entry.name} {f'is {type_name}, and ' if type_name else ''}cannot be {value!r}")
