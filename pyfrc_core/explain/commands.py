"""What is bound to a trigger of commands2 and is no command: an error when the trigger fires, far from its line."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from typing import TypeAlias

from ..errors import text_of
from ..project.robot_files import RobotFiles
from ..season.spelling import normalized
from .explanation import Explanation
from .other_season import in_2027
from .places import last_name, robot_calls, robot_trees

_NO_COMMAND = re.compile(
    r"AttributeError: '(NoneType|function|method)' object has no attribute '(schedule|cancel|isScheduled)'"
    r"|TypeError: Command\.\w+\(\) missing 1 required positional argument: 'self'"
)
#: What in a function makes a command.
_MAKES_COMMAND = re.compile(r"\bcommands2\b|\bself\.(?:run|runOnce|runEnd|startEnd)\(|Command\(")
#: The methods of triggers that take a command, as `normalized` spells them.
BINDINGS = frozenset({"ontrue", "onfalse", "onchange", "whiletrue", "whilefalse", "toggleontrue", "toggleonfalse"})

Definition: TypeAlias = tuple[str, ast.FunctionDef | ast.ClassDef]


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if not _NO_COMMAND.match(text_of(error)) or files.innermost_line(error.__traceback__, tests=False) is not None:
        return None
    defined = dict(users_definitions(robot_trees(files)))
    for place, call in robot_calls(files):
        if is_binding(call) and call.args and (found := no_command(call.args[0], defined)):
            return Explanation(f"{last_name(call.func)}() got {found[0]}", found[1], place)
    return None


def is_binding(call: ast.Call) -> bool:
    """Return whether a command is bound to a trigger."""
    return normalized(last_name(call.func)) in BINDINGS


def users_definitions(trees: Iterable[tuple[str, ast.Module]]) -> Iterator[tuple[str, Definition]]:
    """Yield the functions and classes of files by name, each with its place."""
    for file, tree in trees:
        for each in ast.walk(tree):
            if isinstance(each, (ast.FunctionDef, ast.ClassDef)):
                yield each.name, (f"{file}:{each.lineno}", each)


def no_command(bound: ast.expr, defined: dict[str, Definition]) -> tuple[str, str] | None:
    """Return what is bound, and what to write, if that is no command."""
    written = ast.unparse(bound)
    run_once = f"Write {in_2027('commands2.cmd.runOnce')}({written}, SUBSYSTEM), with the subsystem that it uses."
    if isinstance(bound, ast.Lambda):
        return f"the function {written}, and no command", run_once
    called = isinstance(bound, ast.Call)
    if (
        isinstance(bound, ast.Call)
        and isinstance(bound.func, ast.Attribute)
        and bound.func.attr in ("schedule", "cancel")
    ):
        return f"None, from {written}, which runs here, once", f"Write {ast.unparse(bound.func.value)} without it."
    place, definition = defined.get(last_name(bound.func if isinstance(bound, ast.Call) else bound), ("", None))
    if isinstance(definition, ast.FunctionDef):
        returns = any(isinstance(each, ast.Return) and each.value is not None for each in ast.walk(definition))
        if called and not returns:
            makes_one = _MAKES_COMMAND.search(ast.unparse(definition)) is not None
            text = f"Write return before the command in {definition.name}() ({place})."
            return f"None, from {written}", text if makes_one else run_once.replace(written, f"lambda: {written}")
        if not called:
            remedy = f"Write {written}(), which returns the command." if returns else run_once
            return f"the function {written}, and no command", remedy
    if isinstance(definition, ast.ClassDef) and not called:
        return f"the class {written}, and no command", f"Write {written}(...), with what its __init__ needs ({place})."
    return None
