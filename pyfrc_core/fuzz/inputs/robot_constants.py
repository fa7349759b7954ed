"""The numbers, strings and names in a robot's functions: its decisions change at these numbers and strings."""

from __future__ import annotations

import dis
import math
from collections import deque
from collections.abc import Iterable, Iterator
from enum import Enum
from types import CodeType, FunctionType
from typing import Any, TypeVar

from .values import RobotConstants

_T = TypeVar("_T")

#: More constants would make each of them rare.
_MOST = 200

#: Longer strings, and those with a space, are docstrings and messages.
_LONGEST_TEXT = 24

_CONTAINERS = (tuple, list, set, frozenset)


def find_constants(functions: Iterable[FunctionType]) -> RobotConstants:
    """Return the constants of these functions, and those of their modules that they name."""
    found: set[object] = set()
    compared: set[float] = set()
    names: set[str] = set()
    spaces: dict[int, dict[str, Any]] = {}
    for function in functions:
        for code in _all_code(function.__code__):
            names.update(code.co_names)
            compared.update(_compared(code))
            for constant in code.co_consts:
                found.update(_plain(constant))
        spaces[id(function.__globals__)] = function.__globals__
    modules = {space.get("__name__") for space in spaces.values()}
    for space in spaces.values():
        for name, value in list(space.items()):
            if name.startswith("__"):
                continue
            if isinstance(value, type):
                if value.__module__ in modules:
                    found.update(each for part in list(vars(value).values()) for each in _plain(part))
            elif name in names:
                found.update(_plain(value))
    numbers = {float(each) for each in found if isinstance(each, int | float)}
    texts = {each for each in found if isinstance(each, str)}
    return RobotConstants(_some(numbers), _some(compared), _some(texts), frozenset(names))


def _some(found: set[_T]) -> tuple[_T, ...]:
    """Return these in order, if there are too many a part from the whole range."""
    every = sorted(found)  # type: ignore[type-var]
    return tuple(every[:: 1 + len(every) // _MOST])


def _compared(code: CodeType) -> Iterator[float]:
    """Return the numbers that code compares something with, as far as they stand in the comparison itself."""
    last: deque[object] = deque(maxlen=2)
    for instruction in dis.get_instructions(code):
        if instruction.opname == "COMPARE_OP":
            yield from (float(each) for value in last for each in _plain(value) if not isinstance(each, str))
        last.append(instruction.argval if instruction.opname in ("LOAD_CONST", "LOAD_SMALL_INT") else None)


def _all_code(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _all_code(constant)


def _plain(value: object, depth: int = 0) -> Iterator[float | str]:
    """Return the numbers and strings in a value."""
    if isinstance(value, Enum):
        value = value.value
    if isinstance(value, str):
        if 0 < len(value) <= _LONGEST_TEXT and not any(each.isspace() for each in value):
            yield value
    elif isinstance(value, int | float):
        if not isinstance(value, bool) and math.isfinite(value) and abs(value) < 1e9:
            yield value
    elif isinstance(value, dict) and depth < 3:
        for key, each in value.items():
            yield from _plain(key, depth + 1)
            yield from _plain(each, depth + 1)
    elif type(value) in _CONTAINERS and depth < 3:
        for each in value:  # type: ignore[attr-defined]
            yield from _plain(each, depth + 1)
