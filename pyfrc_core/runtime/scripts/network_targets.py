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

NETWORK = "nt:"
#: The entry in logs of simulations with what was written from outside: texts, each with the JSON of a script's writes.
NETWORK_INPUTS = "/network_inputs"

#: How the types of structs and of bytes begin.
STRUCT, DATA = "struct:", "data("
_TYPED = re.compile(r"((?:struct:\w+|[a-z]+)(?:\[\])?|data\([^()/]+\)):")


def entry_target(name: str, type_name: str = "") -> str:
    """Return the target of an entry; with the name of its type where its values do not show it."""
    return f"{NETWORK}{type_name}:{name}" if type_name else NETWORK + name


def data_target(name: str, type_name: str) -> str:
    """Return the target of an entry that has bytes, by the name of its type."""
    return entry_target(name, f"{DATA}{type_name})")


def struct_target(name: str, type_name: str) -> str | None:
    """Return the target of an entry that has structs; None for other types."""
    return entry_target(name, type_name) if type_name.startswith(STRUCT) else None


def numbers_of(data: bytes) -> list[float]:
    """Return a struct's doubles, as scripts have them; empty if it has other members, or what JSON has no word for."""
    if len(data) % 8:
        return []
    numbers = list(struct.unpack(f"<{len(data) // 8}d", data))
    return numbers if all(map(math.isfinite, numbers)) else []


def parse_entry_target(target: str) -> tuple[str, str]:
    """Return the name of a target's entry, and the name of its type; empty where its values show it."""
    from ...wpi import network  # imports ntcore, which front ends do without

    rest = target.removeprefix(NETWORK)
    typed = _TYPED.match(rest)  # the name of an entry may begin without a slash
    if typed is not None and (
        typed[1].removesuffix("[]") in network.TYPES or typed[1].startswith(STRUCT) or typed[1].startswith(DATA)
    ):
        return rest[typed.end() :], typed[1]
    type_name, unknown, name = rest.partition(":/")
    return (f"/{name}", type_name) if unknown and "/" not in type_name else (rest, "")
