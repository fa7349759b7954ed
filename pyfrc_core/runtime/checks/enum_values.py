"""Find values of the driver station and of devices that are compared with what they never are, or read too early.

``DriverStation.getAlliance() == "Red"`` is always False, and in `robotInit` there is no alliance yet.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache
from typing import Any

from ...explain.alliance import READ_LATER, UNKNOWN_AT_FIRST
from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...explain.returned import class_of, public_name, returned_type
from ...wpi import names
from .kinds import Kinds
from .sources import CodeWarning, SourceFile, methods_of

_AT_START = ("robotInit", "robot_init", "createObjects")
#: The methods of joysticks that read an axis.
_AXIS = re.compile(r"get_?(raw_?axis|twist|throttle|(left|right)_?trigger_?axis|(left_?|right_?)?[xyz])", re.IGNORECASE)
_STARTED_AT_ONCE = ("Robot", "Subsystem", "SubsystemBase", "Container")


def find_wrong_comparisons(sources: list[SourceFile]) -> Iterator[CodeWarning]:
    """Yield comparisons of an enum's value with a text or a number."""
    for source in sources:
        held = {
            last_name(target): last_name(node.value.func)
            for node in source.all(ast.Assign)
            if isinstance(node.value, ast.Call)
            for target in node.targets
        }
        for node in source.all(ast.Compare):
            sides = (node.left, *node.comparators)
            constants = [each for side in sides for each in _constants(side)]
            for side in sides if constants else ():
                function = last_name(side.func) if isinstance(side, ast.Call) else held.get(last_name(side), "")
                if enum := _enums().get(function):
                    yield _never_equal(enum, constants[0], source, node)


def _constants(side: ast.expr) -> list[str | int]:
    """Return the texts and numbers of one side of a comparison, which may be a list of them."""
    items = side.elts if isinstance(side, (ast.List, ast.Tuple, ast.Set)) else [side]
    return [each.value for each in items if isinstance(each, ast.Constant) and isinstance(each.value, (str, int))]


def _never_equal(enum: type[Any], value: str | int, source: SourceFile, node: ast.Compare) -> CodeWarning:
    path = public_name(enum)
    members = {each.lower(): each for each in enum.__members__}
    close = get_close_matches(f"k{value}".lower(), members, n=1) or get_close_matches(str(value).lower(), members, n=1)
    instead = f"{path}.{members[close[0]]}" if close else f"one of {path}: {', '.join(members.values())}"
    kind = "text" if isinstance(value, str) else "number"
    text = f"a value of {enum.__qualname__} is never equal to the {kind} {value!r}"
    return source.warning(node, text, f"Write {instead}")


@cache
def _enums() -> dict[str, type[Any]]:
    """Return the enums that WPILib's functions return, by their name, if all of this name return it."""
    found: dict[str, type[Any] | None] = {}
    for module in [each for name, each in list(sys.modules.items()) if name in names.LIBRARIES]:
        for cls in [each for each in vars(module).values() if isinstance(each, type)]:
            for name in [each for each in vars(cls) if each[0] != "_" and callable(getattr(cls, each))]:
                enum = class_of(returned_type(getattr(cls, name)))
                found[name] = enum if hasattr(enum, "__members__") and found.get(name, enum) is enum else None
    return {name: enum for name, enum in found.items() if enum is not None}


def find_early_reads(sources: list[SourceFile]) -> Iterator[CodeWarning]:
    """Yield where the alliance is read once, before the driver station is connected."""
    for source in sources:
        count = sum(last_name(each.func) in UNKNOWN_AT_FIRST for each in source.all(ast.Call))
        for method in _run_at_start(source) if count == 1 else ():
            looks = any(isinstance(each, ast.Is | ast.IsNot) for each in ast.walk(method))  # is it None?
            for call in _calls_at_once(method):
                if (what := UNKNOWN_AT_FIRST.get(last_name(call.func))) and not looks:
                    text = f"the {what} is not known yet in {method.name}: {last_name(call.func)}() is None"
                    yield source.warning(call, f"{text} until the driver station is connected", in_2027(READ_LATER))


def find_sticks_read_once(kinds: Kinds) -> Iterator[CodeWarning]:
    """Yield where a joystick's axis is read once, at the start, such as for a command that should follow it."""
    for source in kinds.robot:
        for method in _run_at_start(source):
            signed = {id(each.operand): each for each in ast.walk(method) if isinstance(each, ast.UnaryOp)}
            for call in _calls_at_once(method):
                owner = kinds.owner(call, source)
                hid = any(each.__name__.endswith("GenericHID") for each in getattr(owner, "__mro__", ()))
                if hid and _AXIS.fullmatch(last_name(call.func)):
                    written = ast.unparse(signed.get(id(call), call))
                    text = f"{method.name} runs once, so this is the stick's position at the start, and never changes"
                    remedy = f"For a command, write lambda: {written} and call it there; else read it in "
                    yield source.warning(call, text, in_2027(f"{remedy}teleopPeriodic."))


def _run_at_start(source: SourceFile) -> Iterator[ast.FunctionDef]:
    """Yield the methods that run when the robot program starts."""
    for cls in source.all(ast.ClassDef):
        at_once = any(last_name(base).endswith(_STARTED_AT_ONCE) for base in cls.bases)
        at_once = at_once or cls.name.endswith(_STARTED_AT_ONCE)
        for method in methods_of(cls):
            if method.name in _AT_START or (method.name == "__init__" and at_once):
                yield method


def _calls_at_once(node: ast.AST) -> Iterator[ast.Call]:
    """Yield the calls in a function, without those in functions that are made in it and called later."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, (ast.Lambda, ast.FunctionDef)):
            if isinstance(child, ast.Call):
                yield child
            yield from _calls_at_once(child)
