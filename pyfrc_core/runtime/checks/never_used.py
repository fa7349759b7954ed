"""Find what is made, and then never started, returned or called."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass

from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...season.spelling import normalized
from .kinds import Kinds, object_of
from .sources import CodeWarning, SourceFile


@dataclass(frozen=True)
class _Started:
    """A class whose objects are useless before they are started.

    :param starts: the methods that start them, as `normalized` spells them; the first one in the class is the remedy
    :param uses: those that use them; empty: that they are made is enough
    :param effect: what happens if they are not started
    :param write: the remedy, if it is more than the call
    """

    starts: tuple[str, ...]
    uses: tuple[str, ...]
    effect: str
    write: str = ""


_STARTED = {
    "Timer": _Started(
        ("restart", "start"), ("get", "haselapsed", "advanceifelapsed"), "is never started, so it stays at 0 s"
    ),
    "AddressableLED": _Started(("start",), ("setdata",), "is never started, so it stays dark"),
    "Notifier": _Started(("startperiodic", "startsingle"), (), "is never started, so its function is never called"),
    "DoubleSolenoid": _Started(
        ("set",),
        ("toggle",),
        "is never set, so toggle() does nothing: it is off",
        "{}.set(wpilib.DoubleSolenoid.Value.kReverse)",
    ),
    "SendableChooser": _Started(
        (), ("getselected",), "is on no dashboard", 'wpilib.SmartDashboard.putData("Autonomous", {})'
    ),
}


def find_never_used(kinds: Kinds) -> Iterator[CodeWarning]:
    attributes = [each for source in kinds.sources for each in source.all(ast.Attribute)]
    used = {(last_name(each.value), normalized(each.attr)) for each in attributes}
    owners = {id(each.value) for each in attributes}
    passed_on = {  # what has an object under another name may start it
        last_name(node)
        for source in kinds.sources
        for node in source.nodes
        if isinstance(node, (ast.Attribute, ast.Name)) and isinstance(node.ctx, ast.Load) and id(node) not in owners
    }
    for source in kinds.sources:
        for node in (each for each in source.nodes if isinstance(each, (ast.Assign, ast.AnnAssign))):
            target = node.targets[0] if isinstance(node, ast.Assign) else node.target
            made = object_of(node.value.func, source) if isinstance(node.value, ast.Call) else None
            row = _STARTED.get(made.__name__) if isinstance(made, type) and made.__module__.startswith("wpi") else None
            name = last_name(target)
            if row is None or name in passed_on or any((name, each) in used for each in row.starts):
                continue
            if not row.uses or any((name, each) in used for each in row.uses):
                start = next((f"{{}}.{each}()" for each in dir(made) if normalized(each) in row.starts), "")
                if not (row.write or start):
                    continue  # needs no start in this season
                code = in_2027(row.write or start).format(ast.unparse(target))
                at, remedy = source.at(node), f"Write {code} below this line."
                if row is _STARTED["Timer"]:  # which counts from where it is started
                    remedy = f"Write {code} where it begins to count, as in {in_2027('autonomousInit')}."
                    if reset := next(_calls(kinds.sources, name, "reset"), None):
                        at, remedy = reset[0].at(reset[1]), f"Write {code} in place of reset()."
                yield CodeWarning(at, f"{ast.unparse(target)} {row.effect}", remedy)
        yield from _defined_twice(source.tree, source)
        for cls in source.all(ast.ClassDef):
            yield from _defined_twice(cls, source)


def _calls(files: Collection[SourceFile], name: str, method: str) -> Iterator[tuple[SourceFile, ast.Call]]:
    """Yield the calls of a method, named by a regular expression, of the object that has a name."""
    for source in files:
        for node in source.all(ast.Call):
            func = node.func
            if isinstance(func, ast.Attribute) and last_name(func.value) == name and re.fullmatch(method, func.attr):
                yield source, node


def find_unmatched_keys(files: Collection[SourceFile]) -> Iterator[CodeWarning]:
    """Yield where SmartDashboard is asked for a key that is only put in another spelling."""
    places: dict[str, dict[str, dict[str, str]]] = {"put": {}, "get": {}}
    for source, call in _calls(files, "SmartDashboard", "(put|get).+"):
        key = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else None
        if isinstance(key, str):
            alike = re.sub(r"[\W_]", "", key).lower()
            places[last_name(call.func)[:3]].setdefault(alike, {}).setdefault(key, source.at(call))
    for alike, got in places["get"].items():
        put = places["put"].get(alike, {})
        for key in sorted(got.keys() - put.keys()) if put else ():
            other, where = next(iter(put.items()))
            text = f"this asks the dashboard for {key!r}, and {where} puts {other!r}"
            yield CodeWarning(got[key], text, "Write the same key in both.")


def _defined_twice(parent: ast.Module | ast.ClassDef, source: SourceFile) -> Iterator[CodeWarning]:
    first: dict[str, int] = {}
    for node in parent.body:
        if isinstance(node, ast.FunctionDef) and not node.decorator_list:
            if node.name in first:
                name = f"{parent.name}.{node.name}" if isinstance(parent, ast.ClassDef) else node.name
                text = f"{name} is defined twice: only this one is called, and the one in line {first[node.name]} never"
                yield source.warning(node, text, "Write the lines of both into one, or rename one of them.")
            first[node.name] = node.lineno
        else:
            for each in ast.walk(node):  # what is between two definitions may use the first
                first.pop(getattr(each, "id", getattr(each, "name", None)) or "", None)
