"""Find what is made, and then never started, returned or called."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator

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
                code = in_2027(write or start).format(written)
                at, remedy = source.at(node), f"Write {code} below this line."
                if kind == "Timer":  # which counts from where it is started
                    remedy = f"Write {code} where it begins to count, as in autonomousInit."
                    resets = (by.at(call) for by, each in nodes for call in _calls(each, name, "reset"))
                    if reset := next(resets, ""):
                        at, remedy = reset, f"Write {code} in place of reset()."
                yield CodeWarning(at, f"{written} {effect}", remedy)
        elif isinstance(node, (ast.Module, ast.ClassDef)):
            yield from _defined_twice(node, source)


def _calls(node: ast.AST, name: str, method: str) -> Iterator[ast.Call]:
    """Yield the node if it calls a method, named by a regular expression, of the object that has a name."""
    if (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and last_name(node.func.value) == name
        and re.fullmatch(method, node.func.attr)
    ):
        yield node


def find_unmatched_keys(files: Collection[Source]) -> Iterator[CodeWarning]:
    """Yield where SmartDashboard is asked for a key that is only put in another spelling."""
    places: dict[str, dict[str, dict[str, str]]] = {"put": {}, "get": {}}
    for source in files:
        for node in ast.walk(source.tree):
            for call in _calls(node, "SmartDashboard", "(put|get).+"):
                key = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else None
                if isinstance(key, str) and isinstance(call.func, ast.Attribute):
                    alike = re.sub(r"[\W_]", "", key).lower()
                    places[call.func.attr[:3]].setdefault(alike, {}).setdefault(key, source.at(call))
    for alike, got in places["get"].items():
        put = places["put"].get(alike, {})
        for key in sorted(got.keys() - put.keys()) if put else ():
            other, where = next(iter(put.items()))
            text = f"this asks the dashboard for {key!r}, and {where} puts {other!r}"
            yield CodeWarning(got[key], text, "Write the same key in both.")


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
