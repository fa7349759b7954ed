"""Find what happens in each loop and should happen once, and modes outside of the robot's class."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...explain.returned import short_name
from ...season.spelling import normalized
from ...wpi import names
from .kinds import Kinds
from .sources import CodeWarning, SourceFile, methods_of

_IN_EACH_LOOP = {each for each in names.OF_MODES if each.endswith(("Periodic", "_periodic"))} | {"execute", "periodic"}
#: Where a loop's variables are made.
_BEGINNINGS = {"execute": "initialize", "periodic": "__init__"}
#: What starts a measurement, a controller or a command again.
_RESTARTS = frozenset({"reset", "restart", "zeroyaw"})


def find_wrong_moments(kinds: Kinds) -> Iterator[CodeWarning]:
    for source in kinds.robot:
        for function in (each for each in source.tree.body if isinstance(each, ast.FunctionDef)):
            if function.name in names.OF_MODES and [each.arg for each in function.args.args] == ["self"]:
                text = f"WPILib never calls {function.name}: it is outside of the robot's class"
                yield source.warning(function, text, "Indent it as much as the methods of the class.")
        for method in (each for cls in source.all(ast.ClassDef) for each in methods_of(cls)):
            if method.name in _IN_EACH_LOOP:
                yield from _in_each_loop(method, kinds, source)


def _in_each_loop(method: ast.FunctionDef, kinds: Kinds, source: SourceFile) -> Iterator[CodeWarning]:
    beginning = _BEGINNINGS.get(method.name, method.name.replace("Periodic", "Init").replace("_periodic", "_init"))
    made_at = "__init__" if method.name in _BEGINNINGS else in_2027("robotInit")
    for statement in _always(method.body):
        for call in (each for each in ast.walk(statement) if isinstance(each, ast.Call)):
            called, written = kinds.called(call, source), ast.unparse(call)
            if isinstance(called, type) and _remembers(called):
                name = last_name(statement.targets[0]) if isinstance(statement, ast.Assign) else short_name(called)
                text = f"{method.name} makes a new {called.__name__} in each loop, which knows nothing of the last one"
                remedy = f"Write self.{name} = {written} in {made_at}, and use self.{name} here"
                yield source.warning(call, text, remedy)
        once = statement.value if isinstance(statement, ast.Expr) else None
        if not isinstance(once, ast.Call) or not isinstance(once.func, ast.Attribute) or once.args:
            continue
        each_time = f"{method.name} is called every 20 ms, and each time"
        if once.func.attr == "schedule":
            new = kinds.makes_command(once.func.value, source)
            what = "a new command, which ends the one before" if new else "the command again, as soon as it has ended"
            bind = f"button.{in_2027('onTrue')}(command)"
            remedy = f"Move it to {beginning}; or bind the command to a button in __init__: {bind}"
            yield source.warning(once, f"{each_time} this line starts {what}", remedy)
        elif normalized(once.func.attr) in _RESTARTS and kinds.is_library(once, source):
            yield source.warning(
                once, f"{each_time} {ast.unparse(once)} starts again from 0", f"Move it to {beginning}."
            )


def _remembers(cls: type[Any]) -> bool:
    """Return whether objects of a library's class compute from what they have got before, or measure time."""
    known = {normalized(each) for each in dir(cls)}
    stateful = "calculate" in known and bool({"reset", "lastvalue", "getdebouncetime", "setdebouncetime"} & known)
    return cls.__module__.startswith(("wpimath", "wpilib")) and (stateful or "haselapsed" in known)


def _always(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements that run each time, also those that only ask whether an object is there."""
    for each in body:
        if isinstance(each, (ast.Return, ast.Raise)):
            return
        if isinstance(each, ast.If):
            asked = each.test.left if isinstance(each.test, ast.Compare) else each.test
            inner = each.body[0]
            if len(each.body) == 1 and ast.unparse(inner).startswith(f"{ast.unparse(asked)}."):
                yield inner
            if any(isinstance(node, ast.Return) for node in ast.walk(each)):
                return
        elif isinstance(each, (ast.Expr, ast.Assign, ast.AnnAssign)):
            yield each
