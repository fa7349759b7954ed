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
from ...explain.returned import class_of, returned_type
from ...wpi import names
from .code_warning import CodeWarning
from .kinds import Kinds
from .sources import Source

_AT_START = ("robotInit", "robot_init", "createObjects")
#: The methods of joysticks that read an axis.
_AXIS = re.compile(r"get_?(raw_?axis|twist|throttle|(left|right)_?trigger_?axis|(left_?|right_?)?[xyz])", re.IGNORECASE)
_STARTED_AT_ONCE = ("Robot", "Subsystem", "SubsystemBase", "Container")


def find_wrong_comparisons(sources: list[Source]) -> Iterator[CodeWarning]:
    """Yield comparisons of an enum's value with a text or a number."""
    for source in sources:
        held = {
            last_name(target): last_name(node.value.func)
            for node in ast.walk(source.tree)
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)
            for target in node.targets
        }
        for node in ast.walk(source.tree):
            if not isinstance(node, ast.Compare):
                continue
            constants = [each for side in (node.left, *node.comparators) for each in _constants(side)]
            for side in (node.left, *node.comparators) if constants else ():
                function = last_name(side.func) if isinstance(side, ast.Call) else held.get(last_name(side), "")
                enum = _enums().get(function)
                if enum is bool and isinstance(constants[0], str):
                    text = f"{ast.unparse(side)} is True or False, and never equal to the text {constants[0]!r}"
                    yield CodeWarning(source.at(node), text, f"Write {ast.unparse(side)} alone, without ==")
                elif enum not in (None, bool):
                    yield _never_equal(enum, constants[0], source.at(node))


def _constants(side: ast.expr) -> list[str | int]:
    """Return the texts and numbers of one side of a comparison, which may be a list of them."""
    items = side.elts if isinstance(side, (ast.List, ast.Tuple, ast.Set)) else [side]
    return [each.value for each in items if isinstance(each, ast.Constant) and isinstance(each.value, (str, int))]


def _never_equal(enum: type[Any], value: str | int, place: str) -> CodeWarning:
    path = f"{enum.__module__.replace('._wpilib', '')}.{enum.__qualname__}"
    members = {each.lower(): each for each in enum.__members__}
    close = get_close_matches(f"k{value}".lower(), members, n=1) or get_close_matches(str(value).lower(), members, n=1)
    instead = f"{path}.{members[close[0]]}" if close else f"one of {path}: {', '.join(members.values())}"
    kind = "text" if isinstance(value, str) else "number"
    return CodeWarning(
        place, f"a value of {enum.__qualname__} is never equal to the {kind} {value!r}", f"Write {instead}"
    )


@cache
def _enums() -> dict[str, type[Any]]:
    """Return the enums, or bool, that WPILib's functions return, by their name, if all of this name return it."""
    found: dict[str, type[Any] | None] = {}
    for module in [each for name, each in list(sys.modules.items()) if name in names.LIBRARIES]:
        for cls in [each for each in vars(module).values() if isinstance(each, type)]:
            for name, function in list(vars(cls).items()):
                if name[0] != "_" and callable(getattr(cls, name)) and not isinstance(function, type):
                    returned = returned_type(getattr(cls, name))
                    enum = bool if returned == "bool" else class_of(returned)
                    is_known = enum is bool or hasattr(enum, "__members__")
                    found[name] = enum if is_known and found.get(name, enum) is enum else None
    return {name: enum for name, enum in found.items() if enum is not None}


def find_early_reads(sources: list[Source]) -> Iterator[CodeWarning]:
    """Yield where the alliance is read once, before the driver station is connected."""
    for source in sources:
        calls = [each for each in ast.walk(source.tree) if _asks(each)]
        for method in _run_at_start(source) if len(calls) == 1 else ():
            looks = any(isinstance(each, ast.Is | ast.IsNot) for each in ast.walk(method))  # is it None?
            for call in (each for each in _at_once(method) if _asks(each) and not looks):
                what = UNKNOWN_AT_FIRST[last_name(call.func)]
                text = f"the {what} is not known yet in {method.name}: {last_name(call.func)}() is None"
                text += " until the driver station is connected"
                yield CodeWarning(source.at(call), text, in_2027(READ_LATER))


def find_sticks_read_once(kinds: Kinds) -> Iterator[CodeWarning]:
    """Yield where a joystick's axis is read once, at the start, such as for a command that should follow it."""
    for source in (each for each in kinds.sources if not each.is_test):
        for method in _run_at_start(source):
            for call in (each for each in _at_once(method) if isinstance(each, ast.Call)):
                owner = kinds.of(call.func.value, source) if isinstance(call.func, ast.Attribute) else None
                hid = any(each.__name__.endswith("GenericHID") for each in getattr(owner, "__mro__", ()))
                if hid and _AXIS.fullmatch(last_name(call.func)):
                    written = ast.unparse(call)
                    text = f"{method.name} runs once, so this is the stick's position at the start, and never changes"
                    remedy = f"For a command, write lambda: {written} and call it there; else read it in "
                    yield CodeWarning(source.at(call), text, in_2027(f"{remedy}teleopPeriodic."))


def _run_at_start(source: Source) -> Iterator[ast.FunctionDef]:
    """Yield the methods that run when the robot program starts."""
    for cls in (each for each in ast.walk(source.tree) if isinstance(each, ast.ClassDef)):
        at_once = any(last_name(base).endswith(_STARTED_AT_ONCE) for base in cls.bases)
        at_once = at_once or cls.name.endswith(_STARTED_AT_ONCE)
        for method in (each for each in cls.body if isinstance(each, ast.FunctionDef)):
            if method.name in _AT_START or (method.name == "__init__" and at_once):
                yield method


def _asks(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) in UNKNOWN_AT_FIRST


def _at_once(node: ast.AST) -> Iterator[Any]:
    """Yield the nodes of a function, without the functions that are made in it and called later."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, (ast.Lambda, ast.FunctionDef)):
            yield child
            yield from _at_once(child)
