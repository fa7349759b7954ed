"""What a library's function returns, from the first line of its documentation, where bindings of C++ write it."""

from __future__ import annotations

import re
import sys
from typing import Any

_RETURNED = re.compile(r"\w+\((?:self: [\w.]+)?(?P<more>.*?)\) -> (?P<type>[\w.]+)(?P<none> \| None)?$")
_NUMBER = re.compile(r"float$|int$|wpimath\.units\.")


def returned_type(function: Any) -> str:
    """Return the full name of the type that a function without further arguments returns; empty if not known."""
    found = _RETURNED.match(str(getattr(function, "__doc__", "")).partition("\n")[0])
    return found["type"] if found else ""


def class_of(name: str) -> type[Any] | None:
    """Return a class by its full name, such as ``wpilib._wpilib.DriverStation.Alliance``."""
    parts = name.split(".")
    for length in range(len(parts) - 1, 0, -1):
        found: Any = sys.modules.get(".".join(parts[:length]))
        for part in parts[length:] if found is not None else ():
            found = getattr(found, part, None)
        if isinstance(found, type):
            return found
    return None


def numbers_of(cls: type[Any]) -> list[str]:
    """Return the methods of a library's class that return a number and need no arguments."""
    return [each for each in dir(cls) if each[0] != "_" and _NUMBER.match(returned_type(getattr(cls, each)))]
