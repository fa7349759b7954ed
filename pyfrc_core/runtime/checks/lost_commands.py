"""Find commands that never run: made and dropped, bound as something else, or behind one that does not end."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator

from ...explain.commands import BINDINGS, is_binding, no_command, users_definitions
from ...explain.other_season import in_2027
from ...explain.places import last_name
from ...season.spelling import normalized
from ...wpi import names
from .kinds import Kinds, object_of
from .sources import CodeWarning, SourceFile

#: What calls the functions that it gets, and throws away what they return.
_CALLING = frozenset({"run", "runonce", "runend", "startend", "runcommand", "instantcommand", "startendcommand"})
#: What runs commands one after the other.
_SEQUENCES = frozenset({"sequence", "repeatingsequence", "sequentialcommandgroup", "andthen", "beforestarting"})


def find_lost_commands(kinds: Kinds) -> Iterator[CodeWarning]:
    robots = kinds.robot if "commands2" in sys.modules else []
    defined = dict(users_definitions((each.name, each.tree) for each in robots))
    callers = {last_name(call.func): place for place, call in _used_calls(robots)}
    for source in robots:
        assigned = {each.id for each in source.all(ast.Name) if isinstance(each.ctx, ast.Store)}
        for function in source.all(ast.FunctionDef):
            for each in (node.value for node in ast.walk(function) if isinstance(node, ast.Expr)):
                if isinstance(each, ast.Call) and kinds.makes_command(each, source):
                    yield _dropped(each, function, source, callers.get(function.name, ""))
        for call in source.all(ast.Call):
            name = last_name(call.func)
            bound = call.args[0] if is_binding(call) and call.args else None
            if bound is not None and last_name(bound) not in assigned and (found := no_command(bound, defined)):
                yield source.warning(call, f"{name}() got {found[0]}", found[1])
            elif normalized(name) in _CALLING:
                yield from _made_inside(call, kinds, source)
            elif normalized(name) in _SEQUENCES:
                yield from _behind_endless(call, kinds, source)
    yield from _without_scheduler(robots)


def _used_calls(robots: list[SourceFile]) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls whose value is used, each with its place, the last first."""
    for source in robots:
        alone = [each.value for each in source.all(ast.Expr)]
        yield from ((source.at(each), each) for each in reversed(source.all(ast.Call)) if each not in alone)


def _dropped(made: ast.Call, function: ast.FunctionDef, source: SourceFile, caller: str) -> CodeWarning:
    """Return what is wrong with a command that is a statement of its own.

    :param caller: the place of a line that uses what the function around returns
    """
    returns = any(isinstance(each, (ast.Return, ast.Yield, ast.YieldFrom)) for each in ast.walk(function))
    if caller and not returns and made is getattr(function.body[-1], "value", None):
        text = f"{function.name}() returns nothing, so {caller} gets None, and not the command"
        return source.warning(made, text, f"Write return {ast.unparse(made).partition('(')[0]}(...)")
    written, changed = ast.unparse(made), made.func.value if isinstance(made.func, ast.Attribute) else None
    if isinstance(changed, (ast.Name, ast.Attribute)) and last_name(made.func) in Kinds([]).decorators:
        kept = ast.unparse(changed)
        text = f"{last_name(made.func)}() returns a new command, which nothing uses; {kept} is unchanged"
        return source.warning(made, text, f"Write {kept} = {written}")
    text = f"{written} makes a command, and nothing runs it"
    bind = in_2027("onTrue")
    if function.name in names.OF_MODES or function.name in names.OF_A_COMMAND:
        once = function.name.replace("Periodic", "Init").replace("_periodic", "_init")
        remedy = f"Write {written}.schedule() in {once}; or bind it to a button, as in button.{bind}({written})"
    else:
        remedy = f"Write return {written}, bind it to a button with {bind}(...), or call .schedule()"
    return source.warning(made, text, remedy)


def _made_inside(call: ast.Call, kinds: Kinds, source: SourceFile) -> Iterator[CodeWarning]:
    """Yield ``runOnce(lambda: self.arm.raise_it())``, where that function returns a command."""
    for each in call.args:
        if isinstance(each, ast.Call) and kinds.returns_nothing(last_name(each.func)):
            text = f"{ast.unparse(each)} runs here, once, and {last_name(call.func)}() gets None"
            right = f"lambda: {ast.unparse(each)}" if each.args else f"{ast.unparse(each.func)} without ()"
            yield source.warning(each, text, f"Write {right}")
        made = each.body if isinstance(each, ast.Lambda) else ast.Call(each, [], [])
        if isinstance(each, (ast.Lambda, ast.Attribute, ast.Name)) and kinds.makes_command(made, source):
            text = f"{ast.unparse(made)} makes a command, which {last_name(call.func)}() throws away: it never runs"
            yield source.warning(call, text, f"Write {ast.unparse(made)} in place of {ast.unparse(call)}")


def _behind_endless(call: ast.Call, kinds: Kinds, source: SourceFile) -> Iterator[CodeWarning]:
    name, parts = normalized(last_name(call.func)), call.args[:-1]
    if name in ("andthen", "beforestarting") and isinstance(call.func, ast.Attribute):
        parts = [call.func.value, *parts] if name == "andthen" else call.args
    for each in parts:
        if kinds.is_endless(each, source):
            written = ast.unparse(each)
            text = f"{written} never ends by itself, so what follows it never begins"
            remedy = f"Write {written}.{in_2027('withTimeout')}(2), in seconds, or .until(condition)"
            yield source.warning(each, text, remedy)


def _without_scheduler(robots: list[SourceFile]) -> Iterator[CodeWarning]:
    """Yield a robot with commands that does not call their scheduler."""
    used = {normalized(last_name(node)) for each in robots for node in each.all(ast.expr)}
    if not used & {*BINDINGS, "schedule", "setdefaultcommand"} or used & {"commandscheduler", "scheduler"}:
        return
    for source in robots:
        for node in (each for each in source.tree.body if isinstance(each, ast.ClassDef)):
            cls = object_of(ast.Name(node.name), source)
            bases = [each.__name__ for each in getattr(cls, "__mro__", ())]
            if "TimedRobot" in bases and not any("CommandRobot" in each for each in bases):
                text = f"no command ever runs: {node.name} is a {ast.unparse(node.bases[0])}, which does not run them"
                yield source.warning(node, text, f"Write class {node.name}(commands2.TimedCommandRobot):")
