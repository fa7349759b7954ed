"""Find what is made, and then never started, returned or called."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...season.spelling import normalized
from .code_warning import CodeWarning
from .kinds import Kinds, object_of
from .sources import Source

_TIMER = {"get", "haselapsed", "advanceifelapsed"}
_TOGGLED = "is never set, so toggle() does nothing: it is off"
#: What is useless before it is started: by the class, the methods that start it, those that use it, the effect, and
#: what to write, if it is more than the call.
_STARTED = {
    "Timer": ({"restart", "start"}, _TIMER, "is never started, so it stays at 0 s", ""),
    "AddressableLED": ({"start"}, {"setdata"}, "is never started, so it stays dark", ""),
    "Notifier": ({"startperiodic", "startsingle"}, set(), "is never started, so its function is never called", ""),
    "DoubleSolenoid": ({"set"}, {"toggle"}, _TOGGLED, "{}.set(wpilib.DoubleSolenoid.Value.kReverse)"),
    "SendableChooser": (
        set(),
        {"getselected"},
        "is on no dashboard",
        'wpilib.SmartDashboard.putData("Autonomous", {})',
    ),
}


def find_never_used(kinds: Kinds) -> Iterator[CodeWarning]:
    nodes = [(source, node) for source in kinds.sources for node in ast.walk(source.tree)]
    attributes = [node for _, node in nodes if isinstance(node, ast.Attribute)]
    used = {(last_name(each.value), normalized(each.attr)) for each in attributes}
    owners = {id(each.value) for each in attributes}
    passed_on = {  # what has an object under another name may start it
        last_name(node)
        for _, node in nodes
        if isinstance(node, (ast.Attribute, ast.Name)) and isinstance(node.ctx, ast.Load) and id(node) not in owners
    }
    for source, node in nodes:
        if isinstance(node, (ast.Assign, ast.AnnAssign)) and isinstance(node.value, ast.Call):
            target, cls = (
                getattr(node, "targets", [getattr(node, "target", None)])[0],
                object_of(node.value.func, source),
            )
            name = last_name(target)
            kind = cls.__name__ if isinstance(cls, type) and cls.__module__.startswith("wpilib") else ""
            starts, uses, effect, write = _STARTED.get(kind, (set(), set(), "", ""))
            start = next((f"{{}}.{each}()" for each in dir(cls) if normalized(each) in starts), "")
            is_used = not uses or any((name, use) in used for use in uses)
            if effect and is_used and name not in passed_on and not any((name, each) in used for each in starts):
                written = ast.unparse(target)
                remedy = f"Write {in_2027(write or start).format(written)} where it is made."
                yield CodeWarning(source.at(node), f"{written} {effect}", remedy)
        elif isinstance(node, (ast.Module, ast.ClassDef)):
            yield from _defined_twice(node, source)


def _defined_twice(parent: ast.Module | ast.ClassDef, source: Source) -> Iterator[CodeWarning]:
    first: dict[str, int] = {}
    for node in parent.body:
        if isinstance(node, ast.FunctionDef) and not node.decorator_list:
            if node.name in first:
                name = f"{parent.name}.{node.name}" if isinstance(parent, ast.ClassDef) else node.name
                text = f"{name} is defined twice: only this one is called, and the one in line {first[node.name]} never"
                yield CodeWarning(source.at(node), text, "Write the lines of both into one, or rename one of them.")
            first[node.name] = node.lineno
        else:
            for each in ast.walk(node):  # what is between two definitions may use the first
                first.pop(getattr(each, "id", getattr(each, "name", None)) or "", None)
