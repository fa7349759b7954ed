"""Where in the user's code an error belongs, if the traceback has no line of it: the class that a library has used."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterable, Iterator
from types import FrameType, FunctionType, TracebackType
from typing import Any

from ..project.robot_files import RobotFiles, is_pyfrc


def frames_of(error: BaseException) -> list[FrameType]:
    """Return the frames of an error's traceback, outermost first, without pyfrc's own."""
    return [frame for frame in _all_frames(error) if not is_pyfrc(frame.f_code.co_filename)]


def _all_frames(error: BaseException) -> list[FrameType]:
    found = []
    entry: TracebackType | None = error.__traceback__
    while entry is not None:
        found.append(entry.tb_frame)
        entry = entry.tb_next
    return found


def _called_by_pyfrc(error: BaseException, files: RobotFiles) -> list[FrameType]:
    """Return the frames of what pyfrc has called last: the robot's and its libraries', and none of the test's."""
    frames = _all_frames(error)
    ours = [at for at, frame in enumerate(frames) if is_pyfrc(frame.f_code.co_filename)]
    called = frames[ours[-1] + 1 :] if ours else []
    # What a test calls itself, or asserts, is at the test's line: the robot among its variables says nothing.
    return [] if any(files.is_project_file(frame.f_code.co_filename) for frame in called) else called


def users_class(error: BaseException, files: RobotFiles, other: str = "") -> type[Any] | None:
    """Return the class of the user's that a library was working with, from the variables of the library's functions.

    The innermost function's come first; `self` comes last in each, since it is often the robot.

    :param other: the full name of a class that it is not
    """
    for frame in reversed(_called_by_pyfrc(error, files)):
        variables = dict(frame.f_locals)
        own = variables.pop("self", None)
        for value in (*variables.values(), own):
            cls = value if isinstance(value, type) else type(value)
            if file_of(cls, files) is not None and f"{cls.__module__}.{cls.__qualname__}" != other:
                return cls
    return None


def place_without_line(error: BaseException, files: RobotFiles) -> str:
    """Return the place of the user's class whose object has raised an error in a library's code; empty if none has.

    Other objects among a library's variables, such as a command's subsystems, say nothing.
    """
    frames = _called_by_pyfrc(error, files)
    cls = type(frames[-1].f_locals.get("self")) if frames else object
    return line_of_class(cls, files)


def users_functions(error: BaseException, files: RobotFiles) -> Iterator[FunctionType]:
    """Yield the functions of the user's that a library's functions, innermost first, had among their variables."""
    for frame in reversed(_called_by_pyfrc(error, files)):
        own = getattr(frame.f_locals.get("self"), "__dict__", {})
        for value in (*frame.f_locals.values(), *own.values()):
            function = getattr(value, "__func__", value)
            if isinstance(function, FunctionType) and files.is_robot_code(function.__code__.co_filename):
                yield function


def class_named(name: str, files: RobotFiles) -> type[Any] | None:
    """Return a class of the user's by its full name, such as ``components.drivetrain.Drivetrain``."""
    module, _, last = name.rpartition(".")
    cls = getattr(sys.modules.get(module), last, None)
    return cls if isinstance(cls, type) and file_of(cls, files) is not None else None


def file_of(cls: type[Any], files: RobotFiles) -> str | None:
    """Return the file of a class, if it is one of the robot's."""
    file = getattr(sys.modules.get(cls.__module__), "__file__", None)
    return file if file is not None and files.is_robot_code(file) else None


def line_of_class(cls: type[Any], files: RobotFiles, name: str = "") -> str:
    """Return the place of a class, such as ``arm.py:4``, or that of a name that its body declares or assigns."""
    file = file_of(cls, files)
    if file is None:
        return ""
    for node in ast.walk(parsed(file)):
        if isinstance(node, ast.ClassDef) and node.name == cls.__name__:
            line = next(_lines_of_name(node, name), node.lineno) if name else node.lineno
            return f"{files.relative(file)}:{line}"
    return files.relative(file)


def is_in_opmode(file: str, line: int) -> bool:
    """Return whether a line of the robot's code is in the class of an opmode."""
    around = {
        node.name
        for node in ast.walk(parsed(file))
        if isinstance(node, ast.ClassDef) and node.lineno <= line <= (node.end_lineno or 0)
    }
    modules = [each for each in list(sys.modules.values()) if getattr(each, "__file__", None) == file]
    classes = [getattr(module, name, None) for module in modules for name in around]
    return any(
        base.__name__ == "OpMode" and base.__module__.startswith("wpilib")
        for cls in classes
        if isinstance(cls, type)
        for base in cls.__mro__
    )


def users_frame(error: BaseException, files: RobotFiles) -> tuple[FrameType, int] | None:
    """Return the frame of the robot's code, or else of a test, nearest to where an error was raised, and its line."""
    found: dict[bool, tuple[FrameType, int]] = {}
    entry = error.__traceback__
    while entry is not None:
        name = entry.tb_frame.f_code.co_filename
        if files.is_project_file(name):
            found[files.is_robot_code(name)] = entry.tb_frame, entry.tb_lineno
        entry = entry.tb_next
    return found.get(True) or found.get(False)


def statement_at(frame: FrameType, line: int) -> ast.AST:
    """Return the innermost statement at a line of a file; of an if, while, for or with, the expression in its head."""
    statements = [each for each in ast.walk(parsed(frame.f_code.co_filename)) if isinstance(each, ast.stmt)]
    at = [each for each in statements if each.lineno <= line <= (each.end_lineno or 0)] or [ast.Pass(lineno=0)]
    found = next((each for each in at if each.lineno == line and hasattr(each, "body")), at[-1])  # if x: pass
    if isinstance(found, (ast.With, ast.AsyncWith)):
        return ast.Tuple([item.context_expr for item in found.items])
    head = getattr(found, "test", None) or getattr(found, "iter", None)
    return head if isinstance(head, ast.expr) else found


def place_of_assignment(cls: type[Any], files: RobotFiles, name: str) -> tuple[str, str, str]:
    """Return where a method of a class assigns a name, what it assigns to (``self.arm`` or ``arm``), and the method."""
    file = file_of(cls, files)
    classes = [each for each in ast.walk(parsed(file)) if isinstance(each, ast.ClassDef)] if file is not None else []
    for method in (each for found in classes if found.name == cls.__name__ for each in found.body):
        for node in ast.walk(method):
            for target in node.targets if isinstance(node, ast.Assign) else []:
                if last_name(target) == name and file is not None:
                    place = f"{files.relative(file)}:{target.lineno}"
                    return place, ast.unparse(target), getattr(method, "name", "")
    return "", "", ""


def robot_trees(files: RobotFiles) -> Iterator[tuple[str, ast.Module]]:
    """Yield the name and the syntax tree of each imported file of the robot."""
    for module in list(sys.modules.values()):
        file = str(getattr(module, "__file__", ""))
        if file and files.is_robot_code(file):
            yield files.relative(file), parsed(file)


def robot_calls(files: RobotFiles) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls in the robot's files, each with its place."""
    for file, tree in robot_trees(files):
        for call in (node for node in ast.walk(tree) if isinstance(node, ast.Call)):
            yield f"{file}:{call.end_lineno}", call


def made_by(name: str, files: RobotFiles) -> Iterator[tuple[str, str, ast.Call]]:
    """Yield where the robot's files make an object of a class: the place, what it is assigned to, and the call."""
    for file, tree in robot_trees(files):
        for node in ast.walk(tree):
            value = node.value if isinstance(node, ast.Assign) else None
            if isinstance(node, ast.Assign) and isinstance(value, ast.Call) and last_name(value.func) == name:
                yield f"{file}:{node.lineno}", ast.unparse(node.targets[0]), value


def beginning(frame: FrameType) -> str:
    """Return the method in which the object whose method runs makes what it has."""
    known = dir(frame.f_locals.get("self"))
    return next((each for each in ("createObjects", "robotInit", "robot_init") if each in known), "__init__")


def without_return(written: str, files: RobotFiles) -> str:
    """Return what to write in the user's function, if an expression is the call of one that returns nothing."""
    for file, tree in robot_trees(files):
        for each in ast.walk(tree):
            if isinstance(each, ast.FunctionDef) and re.search(rf"\b{each.name}\([^()]*\)$", written):
                last = each.body[-1]
                if not any(isinstance(node, ast.Return) for node in ast.walk(each)):
                    what = ast.unparse(last) if isinstance(last, ast.Expr) else "its value"
                    return f"{each.name}() returns nothing: write return {what} in {file}:{last.lineno}"
    return ""


def calls_at(frame: FrameType, line: int, name: str) -> list[ast.Call]:
    """Return the calls of a function or class, by its last name, in the statement at a line of a file."""
    calls = [node for node in ast.walk(parsed(frame.f_code.co_filename)) if isinstance(node, ast.Call)]
    return [
        call for call in calls if call.lineno <= line <= (call.end_lineno or 0) and name in ("", last_name(call.func))
    ]


#: The value of an expression that is not looked up.
UNKNOWN = object()


def value_of(expression: ast.expr, frame: FrameType) -> Any:
    """Return the value of a constant or dotted name, such as ``self.timer.get``; `UNKNOWN` for other expressions."""
    if isinstance(expression, ast.Attribute):
        return getattr(value_of(expression.value, frame), expression.attr, UNKNOWN)
    if isinstance(expression, ast.Constant):
        return expression.value
    if isinstance(expression, ast.Name):
        return frame.f_locals.get(expression.id, frame.f_globals.get(expression.id, UNKNOWN))
    return UNKNOWN


def owner_of(expression: ast.expr, frame: FrameType) -> Any:
    """Return the object before the last dot; `UNKNOWN` if there is none."""
    return value_of(expression.value, frame) if isinstance(expression, ast.Attribute) else UNKNOWN


def functions_around(frame: FrameType, line: int) -> list[ast.FunctionDef]:
    """Return the functions whose text has a line of a file, the outermost first."""
    functions = [each for each in ast.walk(parsed(frame.f_code.co_filename)) if isinstance(each, ast.FunctionDef)]
    return [each for each in functions if each.lineno <= line <= (each.end_lineno or 0)]


def passed_to(call: ast.Call, parameters: Iterable[str]) -> dict[str, ast.expr]:
    """Return the arguments of a call, by the names of the function's parameters (without `self`)."""
    named = {each.arg: each.value for each in call.keywords if each.arg}
    return dict(zip((each for each in parameters if each != "self"), call.args, strict=False)) | named


def last_name(expression: ast.expr) -> str:
    """Return ``set`` of ``self.motor.set``; empty for other expressions."""
    if isinstance(expression, ast.Attribute):
        return expression.attr
    return expression.id if isinstance(expression, ast.Name) else ""


def _lines_of_name(node: ast.ClassDef, name: str) -> Iterator[int]:
    for each in ast.walk(node):
        if isinstance(each, ast.Assign):
            names = [last_name(target) for target in each.targets]
        else:
            names = [last_name(each.target)] if isinstance(each, ast.AnnAssign) else []
            names += [each.arg] if isinstance(each, ast.arg) else []
            names += [each.name] if isinstance(each, ast.FunctionDef) else []
        if name in names and isinstance(each, (ast.stmt, ast.arg)):
            yield each.lineno


def parsed(file: str) -> ast.Module:
    """Return a file's syntax tree; an empty one if it cannot be read."""
    try:
        with open(file, "rb") as source:  # noqa: PTH123
            return ast.parse(source.read())
    except (OSError, SyntaxError, ValueError):  # has changed since
        return ast.Module([], [])


def imported_name(error: ImportError) -> str:
    """Return the name that a module does not have: ``Arm`` of ``from arm import Arm``. Empty for other errors."""
    found = re.match(r"cannot import name '(\w+)'", str(error))
    return found[1] if found else ""
