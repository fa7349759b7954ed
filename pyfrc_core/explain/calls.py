"""Calls that Python refuses: a method without its brackets, a module for its class, too many or too few values."""

from __future__ import annotations

import ast
import inspect
import re
from types import FrameType, ModuleType

from ..errors import text_of
from ..project.robot_files import RobotFiles
from ..wording import counted
from .explanation import Explanation
from .places import calls_at, last_name, statement_at, users_frame, value_of

_OPERAND = re.compile(
    r"TypeError: (bad operand|unsupported operand|'.+' not supported between).*"
    r"'(method|builtin_function_or_method|function|instancemethod)'"
)
_COUNT = re.compile(
    r"TypeError: (?:[\w.<>]+\.)?(?P<name>\w+)\(\) "
    r"(takes .* positional arguments?|missing \d+ required|got an unexpected keyword argument '(?P<keyword>\w+)')"
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    text = text_of(error)
    where = users_frame(error, files)
    if where is None:
        return None
    if _OPERAND.match(text):
        return _not_called(*where)
    if text == "TypeError: 'module' object is not callable":
        return _module(*where)
    if found := _COUNT.match(text):
        return _count(found, *where, files)
    return None


def _not_called(frame: FrameType, line: int) -> Explanation | None:
    """Explain a method among numbers, such as ``self.timer.get < 2``."""
    for node in ast.walk(statement_at(frame, line)):
        for each in _operands(node):
            if isinstance(each, (ast.Attribute, ast.Name)) and callable(value_of(each, frame)):
                written = ast.unparse(each)
                return Explanation(f"{written} is a function, and not its value", f"Write {written}()")
    return None


def _operands(node: ast.AST) -> list[ast.expr]:
    if isinstance(node, ast.UnaryOp):
        return [node.operand]
    if isinstance(node, ast.Call) and last_name(node.func) in ("abs", "max", "min", "round"):
        return node.args
    if isinstance(node, ast.BinOp):
        return [node.left, node.right]
    return [node.left, *node.comparators] if isinstance(node, ast.Compare) else []


def _module(frame: FrameType, line: int) -> Explanation | None:
    """Explain ``arm()`` for ``arm.Arm()``, and ``time()`` for ``time.time()``."""
    for call in calls_at(frame, line, ""):
        module = value_of(call.func, frame)
        if not isinstance(module, ModuleType):
            continue
        name = ast.unparse(call.func)
        known = [each for each, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__]
        same = [each for each in vars(module) if each.lower() == last_name(call.func).lower()]
        meant = next(iter([*same, *known]), "NAME")
        return Explanation(f"{name} is a module, and cannot be called", f"Write {name}.{meant}(), or what else it has")
    return None


def _count(found: re.Match[str], frame: FrameType, line: int, files: RobotFiles) -> Explanation | None:
    """Explain a call with the wrong number of values, or a wrong name; Python counts `self` among them."""
    for call in calls_at(frame, line, ""):
        called = value_of(call.func, frame)
        name = ast.unparse(call.func)
        function = vars(called).get("__init__") if isinstance(called, type) else called
        if getattr(function, "__name__", "") != found["name"]:
            continue
        parameters = [
            each.name if each.default is each.empty else f"{each.name}={each.default!r}"
            for each in inspect.signature(called).parameters.values()
        ]
        code = getattr(function, "__code__", None)
        ours = code is not None and files.is_project_file(code.co_filename)
        at = f" ({files.relative(code.co_filename)}:{code.co_firstlineno})" if code is not None and ours else ""
        got = f"with {counted(len(call.args) + len(call.keywords), 'value')}"
        if found["keyword"]:
            got = f"with {found['keyword']}="
        return Explanation(f"{name}() was called {got}", f"It takes: {name}({', '.join(parameters)}){at}")
    return None
