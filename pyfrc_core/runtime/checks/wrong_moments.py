"""Find what happens in each loop and should happen once, and a drive that is set once and not in each loop."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...explain.returned import short_name
from ...season.spelling import normalized
from ...wpi import names
from .code_warning import CodeWarning
from .kinds import Kinds
from .sources import Source

_IN_EACH_LOOP = {each for each in names.OF_MODES if each.endswith(("Periodic", "_periodic"))} | {"execute", "periodic"}
#: Where a loop's variables are made.
_BEGINNINGS = {"execute": "initialize", "periodic": "__init__"}
#: What starts a measurement, a controller or a command again.
_RESTARTS = frozenset({"reset", "restart", "zeroyaw"})


def find_wrong_moments(kinds: Kinds) -> Iterator[CodeWarning]:
    for source in (each for each in kinds.sources if not each.is_test):
        for function in (each for each in source.tree.body if isinstance(each, ast.FunctionDef)):
            if function.name in names.OF_MODES and [each.arg for each in function.args.args] == ["self"]:
                text = f"WPILib never calls {function.name}: it is outside of the robot's class"
                yield CodeWarning(source.at(function), text, "Indent it as much as the methods of the class.")
        for cls in (each for each in ast.walk(source.tree) if isinstance(each, ast.ClassDef)):
            methods = {each.name: each for each in cls.body if isinstance(each, ast.FunctionDef)}
            for method in methods.values():
                if method.name in _IN_EACH_LOOP:
                    yield from _in_each_loop(method, kinds, source)
                elif method.name in names.OF_MODES or method.name == "initialize":
                    yield from _once(method, methods, kinds, source)


def _in_each_loop(method: ast.FunctionDef, kinds: Kinds, source: Source) -> Iterator[CodeWarning]:
    beginning = _BEGINNINGS.get(method.name, method.name.replace("Periodic", "Init").replace("_periodic", "_init"))
    made_at = "__init__" if method.name in _BEGINNINGS else in_2027("robotInit")
    for statement in _always(method.body):
        for call in (each for each in ast.walk(statement) if isinstance(each, ast.Call)):
            called, written = kinds.called(call, source), ast.unparse(call)
            if isinstance(called, type) and _remembers(called):
                name = last_name(statement.targets[0]) if isinstance(statement, ast.Assign) else short_name(called)
                text = f"{method.name} makes a new {called.__name__} in each loop, which knows nothing of the last one"
                remedy = f"Write self.{name} = {written} in {made_at}, and use self.{name} here"
                yield CodeWarning(source.at(call), text, remedy)
        once = statement.value if isinstance(statement, ast.Expr) else None
        if not isinstance(once, ast.Call) or not isinstance(once.func, ast.Attribute):
            continue
        if once.func.attr == "schedule" and not once.args:
            new = kinds.makes_command(once.func.value, source)
            what = "a new command, which ends the one before" if new else "the command again, as soon as it has ended"
            text = f"{method.name} is called every 20 ms, and each time this line starts {what}"
            remedy = f"Move it to {beginning}; or bind the command to a button in __init__: button.onTrue(command)"
            yield CodeWarning(source.at(once), text, remedy)
        elif normalized(once.func.attr) in _RESTARTS and not once.args and kinds.is_library(once, source):
            text = f"{method.name} is called every 20 ms, and each time {ast.unparse(once)} starts again from 0"
            yield CodeWarning(source.at(once), text, f"Move it to {beginning}.")


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


def _once(
    method: ast.FunctionDef, methods: dict[str, ast.FunctionDef], kinds: Kinds, source: Source
) -> Iterator[CodeWarning]:
    """Yield a drive that is set in ``autonomousInit`` and not in ``autonomousPeriodic``: motor safety stops it."""
    again = (
        "execute"
        if method.name == "initialize"
        else method.name.replace("Init", "Periodic").replace("_init", "_periodic")
    )
    calls = [each for each in ast.walk(methods.get(again, ast.Pass())) if isinstance(each, ast.Call)]
    for statement in (each for each in method.body if isinstance(each, ast.Expr) and again != method.name):
        call = statement.value
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Attribute):
            continue
        owner = kinds.of(call.func.value, source)
        moves = any(not isinstance(each, ast.Constant) or each.value for each in call.args)
        is_drive = any(each.__name__ == "RobotDriveBase" for each in getattr(owner, "__mro__", ()))
        if is_drive and moves and normalized(call.func.attr).endswith("drive") and not calls:
            written = ast.unparse(call)
            text = f"{written} is called once, and motor safety stops the motors after 0.1 s without another call"
            yield CodeWarning(source.at(call), text, f"Write {written} in {again}, which is called every 20 ms.")
