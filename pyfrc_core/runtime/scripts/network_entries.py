"""Entries of NetworkTables as targets of input scripts.

``nt:/SmartDashboard/x`` has the type of its value, and a number is a double. Where that is not so, the target names the
type as NetworkTables does: ``nt:int:/vision/id``, ``nt:double[]:/limelight/botpose`` (also for an empty list),
``nt:struct:Pose2d:/vision/pose``, whose value is a list of the struct's numbers (structs of doubles only). In lists of
doubles and in structs, ``"nan"`` is not a number: JSON has no word for it. ``nt:data(struct:Pose2d):/vision/pose`` has
the bytes of any type that consists of bytes, as hexadecimal digits.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable, Sequence
from typing import Any

from ...errors import UsageError
from ...wpi import network

NETWORK = "nt:"
#: The entry in logs of simulations with what was written from outside: texts, each with the JSON of a script's writes.
NETWORK_INPUTS = "/network_inputs"

#: What cameras send for a pose that they could not compute.
NOT_A_NUMBER = "nan"

_STRUCT, _DATA = "struct:", "data("
_DOUBLES = ("float[]", "double[]")
_TYPED = re.compile(r"((?:struct:\w+|[a-z]+)(?:\[\])?|data\([^()/]+\)):")

#: Writes a value to one entry, with its time in microseconds; None: now.
_Writer = Callable[[Any, "int | None"], None]


def entry_target(name: str, type_name: str = "") -> str:
    """Return the target of an entry; with the name of its type where its values do not show it."""
    return f"{NETWORK}{type_name}:{name}" if type_name else NETWORK + name


def data_target(name: str, type_name: str) -> str:
    """Return the target of an entry that has bytes, by the name of its type."""
    return entry_target(name, f"{_DATA}{type_name})")


def struct_target(name: str, type_name: str) -> str | None:
    """Return the target of an entry that has structs; None for other types."""
    return entry_target(name, type_name) if type_name.startswith(_STRUCT) else None


def numbers_of(data: bytes) -> list[float]:
    """Return a struct's doubles, as scripts have them; empty if it has other members, or what JSON has no word for."""
    if len(data) % 8:
        return []
    numbers = list(struct.unpack(f"<{len(data) // 8}d", data))
    return numbers if all(map(math.isfinite, numbers)) else []


def parse_entry_target(target: str) -> tuple[str, str]:
    """Return the name of a target's entry, and the name of its type; empty where its values show it."""
    rest = target.removeprefix(NETWORK)
    typed = _TYPED.match(rest)  # the name of an entry may begin without a slash
    if typed is None or not (
        typed[1].removesuffix("[]") in network.TYPES or typed[1].startswith(_STRUCT) or typed[1].startswith(_DATA)
    ):
        type_name, slash, name = rest.partition("/")
        return slash + name if slash else type_name, type_name.removesuffix(":") if slash else ""
    return rest[typed.end() :], typed[1]


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
    if type_name.startswith(_STRUCT):
        structs = network.DataEntry(name, type_name)
        at_end(structs.unpublish)

        def write_struct(value: Sequence[float], at_us: int | None) -> None:
            try:
                structs.write(struct.pack(f"<{len(value)}d", *map(_number, value)), at_us)
            except (TypeError, struct.error):
                raise UsageError(f"{name} is a struct, written as a list of its numbers, not {value!r}") from None

        return write_struct
    if type_name.startswith(_DATA):
        data = network.DataEntry(name, type_name.removeprefix(_DATA).removesuffix(")"))
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
