"""What a library's function returns, from the first line of its documentation, where bindings of C++ write it."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from typing import Any

_RETURNED = re.compile(r"\w+\((?:self: [\w.]+)?(?P<more>.*?)\) -> (?P<type>[\w.]+)(?P<none> \| None)?$")
#: Bases that say little about a class.
_COMMON = ("object", "pybind11_object", "Sendable", "MotorSafety", "ErrorBase")
_NUMBER = re.compile(r"float$|int$|wpimath\.units\.")


def returned_type(function: Any) -> str:
    """Return the full name of the type that a library's function returns; empty if not known."""
    annotated = getattr(function, "__annotations__", {}).get("return")
    if isinstance(annotated, (str, type)):
        of = function.__module__ if isinstance(annotated, str) else annotated.__module__.removeprefix("builtins")
        return f"{of}.{annotated if isinstance(annotated, str) else annotated.__qualname__}".lstrip(".")
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


def maker_of(owner: type[Any], name: str) -> tuple[str, type[Any]] | None:
    """Return a method of a class that returns an object with a name that the class does not have, and its class."""
    methods = (each for each in dir(owner) if each[0] != "_")
    made = ((each, class_of(returned_type(getattr(owner, each)))) for each in methods)
    found = ((each, cls) for each, cls in made if cls is not None and cls is not owner and hasattr(cls, name))
    return min(found, key=lambda each: len(each[0]), default=None)


def returned_by(cls: type[Any], module: str) -> str:
    """Return a method of another class of a module that makes such an object, as ``DoubleTopic.getEntry``."""
    for owner in (each for each in vars(sys.modules[module]).values() if isinstance(each, type)):
        for name in (each for each in vars(owner) if each[0] != "_"):
            if class_of(returned_type(getattr(owner, name))) is cls:
                return f"{owner.__name__}.{name}"
    return ""


def short_name(cls: type[Any]) -> str:
    """Return a name for an object of a class: ``limiter`` of `SlewRateLimiter`."""
    return str(re.findall("[A-Z]+[a-z0-9]*", cls.__name__)[-1]).lower()


def sibling_of(owner: type[Any], name: str, modules: Iterable[str]) -> tuple[str, type[Any]] | None:
    """Return a class of a library, and its module, that is much like another one, and has a name that that has not."""
    shared = {each for each in owner.__mro__[1:] if each.__name__ not in _COMMON}
    found = [
        (module, each)
        for module in modules
        for each in vars(sys.modules.get(module, object)).values()
        if isinstance(each, type) and hasattr(each, name)
        if each.__name__.endswith(owner.__name__) or (shared & set(each.__mro__))
    ]
    return min(found, key=lambda each: (owner not in each[1].__mro__, "Xbox" not in each[1].__name__), default=None)


def public_name(cls: type[Any]) -> str:
    """Return a library's class as code names it: ``wpilib.DriverStation.Alliance``."""
    return re.sub(r"\._\w+", "", f"{cls.__module__}.{cls.__qualname__}")
