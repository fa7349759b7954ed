"""Find files that robot code opens by a path that only this computer has: it passes here, and fails on the robot.

Only paths that stand in the call, or in a name that its file assigns, are found. The robot program runs as a user that
may write into its home directory, temporary ones and USB sticks.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from ...season import CURRENT
from .sources import CodeWarning, SourceFile

#: The functions that write the file or directory of an argument: its name as a keyword. `open` depends on the mode.
_WRITERS = {
    **dict.fromkeys(("basicConfig", "FileHandler", "RotatingFileHandler", "TimedRotatingFileHandler"), "filename"),
    **dict.fromkeys(("mkdir", "makedirs", "write_text", "write_bytes", "touch"), "name"),
    **dict.fromkeys(("start", "set_path"), "dir"),
    "open": "file",
}
#: Those whose argument is a path only for these classes; `start` is the name of many methods.
_OWNERS = {"start": "DataLogManager", "set_path": "SignalLogger"}
_READERS = ("open", "Path", "read_text", "read_bytes")
_WRITABLE = (f"{CURRENT.controller.home}/", "/tmp/", "/var/tmp/", "/media/", "/u/", "/U/", "/dev/", "/proc/", "/sys/")
_OF_A_LAPTOP = re.compile(r"[A-Za-z]:[\\/]|/Users/|/home/(?!lvuser/)|~/(?:Desktop|Documents|Downloads)/")


def find_foreign_paths(sources: list[SourceFile]) -> Iterator[CodeWarning]:
    """Yield the paths in the robot's files that a robot does not have or may not write."""
    for source in sources:
        yield from _in_file(source)


def _in_file(source: SourceFile) -> Iterator[CodeWarning]:
    tree = source.tree
    assigned = {
        target.id: node.value
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for call in _calls_on_robot(tree):
        name, owner = _names(call.func)
        argument = _argument(call, _WRITERS.get(name, "file"))
        if isinstance(argument, ast.Name):
            argument = assigned.get(argument.id, argument)
        if not isinstance(argument, ast.Constant) or not isinstance(argument.value, str):
            continue
        path, where = argument.value, source.at(call)
        writes = _writes(name, owner, call)
        if (writes or name in _READERS) and _OF_A_LAPTOP.match(path):
            text = f"{path} is a path of this computer, which the robot does not have"
            remedy = (
                "Put the file into the directory deploy/ of the project, and open it in wpilib.getDeployDirectory()."
            )
            yield CodeWarning(where, text, remedy)
        elif writes and path.startswith("/") and not path.startswith(_WRITABLE):
            text = f"the robot program may not write {path}: on the robot, this line ends in an error"
            yield CodeWarning(where, text, f"Use a path in {CURRENT.controller.home}, or in /u for a USB stick.")


def _calls_on_robot(node: ast.AST) -> Iterator[ast.Call]:
    """Yield the calls in a part of a program, without those that run in the simulator only."""
    if isinstance(node, ast.Call):
        yield node
    children: list[ast.AST] = list(ast.iter_child_nodes(node))
    if isinstance(node, (ast.If, ast.IfExp)):
        children = [node.test]
        for part, runs in zip((node.body, node.orelse), _on_robot(node.test), strict=True):
            children += (part if isinstance(part, list) else [part]) if runs else []
    for child in children:
        yield from _calls_on_robot(child)


def _on_robot(test: ast.expr) -> tuple[bool, bool]:
    """Return whether what an if with this condition encloses, and its else, may run on the robot."""
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        return _on_robot(test.operand)[::-1]
    if isinstance(test, ast.BoolOp):
        parts = [_on_robot(each) for each in test.values]
        is_and = isinstance(test.op, ast.And)
        bodies, others = [body for body, _ in parts], [other for _, other in parts]
        return (all(bodies), any(others)) if is_and else (any(bodies), all(others))
    name = _names(test.func)[0].replace("_", "").lower() if isinstance(test, ast.Call) else ""
    return name != "issimulation", name != "isreal"


def _names(function: ast.expr) -> tuple[str, str]:
    """Return the names of a function and of the object or module that it belongs to."""
    if isinstance(function, ast.Attribute):
        return function.attr, _names(function.value)[0]
    return (function.id, "") if isinstance(function, ast.Name) else ("", "")


def _argument(call: ast.Call, keyword: str) -> ast.expr | None:
    named = next((each.value for each in call.keywords if each.arg == keyword), None)
    if named is None and isinstance(call.func, ast.Attribute) and isinstance(call.func.value, ast.Call):
        called = call.func.value  # Path("...").mkdir()
        return _argument(called, "") if _names(called.func)[0] == "Path" else None
    return named or (call.args[0] if call.args else None)


def _writes(name: str, owner: str, call: ast.Call) -> bool:
    if name not in _WRITERS or _OWNERS.get(name, owner) != owner:
        return False
    if name != "open":
        return True
    mode = _argument(ast.Call(call.func, call.args[1:], call.keywords), "mode")
    return isinstance(mode, ast.Constant) and isinstance(mode.value, str) and any(each in mode.value for each in "wax+")
