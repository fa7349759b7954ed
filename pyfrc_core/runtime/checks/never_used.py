"""Find what is made, and then never started, returned or called."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from ...explain.commands import BINDINGS
from ...explain.places import last_name
from ...season.spelling import normalized
from .code_warning import CodeWarning
from .sources import Source

#: What is useless before it is started: by the class, the methods that start it, those that use it, and the effect.
_STARTED = {
    "Timer": ({"restart", "start"}, {"get", "haselapsed", "advanceifelapsed"}, "so it stays at 0 s"),
    "AddressableLED": ({"start"}, {"setdata"}, "so it stays dark"),
    "Notifier": ({"startperiodic", "startsingle"}, set(), "so its function is never called"),
}
_BY_SUBSYSTEM = re.compile(r"self\.(run|run_?once|run_?end|start_?end)\([^)]", re.IGNORECASE)


def find_never_used(sources: list[Source]) -> Iterator[CodeWarning]:
    nodes = [(source, node) for source in sources for node in ast.walk(source.tree)]
    attributes = [node for _, node in nodes if isinstance(node, ast.Attribute)]
    used = {(last_name(each.value), normalized(each.attr)) for each in attributes}
    owners, alone = {id(each.value) for each in attributes}, {id(n.value) for _, n in nodes if isinstance(n, ast.Expr)}
    callers, passed_on = {}, set()  # what has an object under another name may start it
    for source, node in reversed(nodes):
        if isinstance(node, ast.Call) and id(node) not in alone:
            callers[last_name(node.func)] = source.at(node)
        if isinstance(node, (ast.Attribute, ast.Name)) and isinstance(node.ctx, ast.Load) and id(node) not in owners:
            passed_on.add(last_name(node))
    functions = [node.name for _, node in nodes if isinstance(node, ast.FunctionDef)]
    for source, node in nodes:
        if isinstance(node, (ast.Assign, ast.AnnAssign)) and isinstance(node.value, ast.Call):
            target, cls = getattr(node, "targets", [getattr(node, "target", None)])[0], _object(node.value.func, source)
            name = last_name(target)
            kind = cls.__name__ if isinstance(cls, type) and cls.__module__.startswith("wpilib") else ""
            starts, uses, effect = _STARTED.get(kind, (set(), set(), ""))
            start = next((each for each in dir(cls) if normalized(each) in starts), None)
            is_used = not uses or any((name, use) in used for use in uses)
            if start and is_used and name not in passed_on and not any((name, each) in used for each in starts):
                text, remedy = f"{ast.unparse(target)} is never started, {effect}", f"{ast.unparse(target)}.{start}()"
                yield CodeWarning(source.at(node), text, f"Write {remedy} before it is used.")
        elif isinstance(node, ast.FunctionDef) and node.name in callers and functions.count(node.name) == 1:
            last = node.body[-1]
            returns = {ast.Return, ast.Yield, ast.YieldFrom} & {type(each) for each in ast.walk(node)}
            if not returns and isinstance(last, ast.Expr) and _makes_command(last.value, source):
                text = f"{node.name}() returns nothing, so {callers[node.name]} gets None, and not the command"
                yield CodeWarning(source.at(last), text, f"Write return {ast.unparse(last).partition('(')[0]}(...)")
        elif isinstance(node, (ast.Module, ast.ClassDef)):
            yield from _defined_twice(node, source)


def _object(expression: ast.expr, source: Source) -> object:
    """Return what a dotted name is in a file; None for anything else."""
    found: object = source.module
    for name in ast.unparse(expression).split("."):
        found = getattr(found, name, None)
    return found


def _makes_command(made: ast.expr, source: Source) -> bool:
    if not isinstance(made, ast.Call) or last_name(made.func) in BINDINGS | {"schedule", "cancel"}:
        return False
    while isinstance(made.func, ast.Attribute) and isinstance(made.func.value, ast.Call):
        made = made.func.value  # the beginning of a chain such as sequence(...).withTimeout(3)
    maker = _object(made.func, source)
    if isinstance(maker, type):
        return any(each.__name__ == "Command" and each.__module__.startswith("commands2") for each in maker.__mro__)
    return getattr(maker, "__module__", None) == "commands2.cmd" or bool(_BY_SUBSYSTEM.match(ast.unparse(made)))


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
