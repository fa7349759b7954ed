"""`robotInit` becomes the constructor: WPILib 2027 does not call it."""

from __future__ import annotations

from typing import Any

import libcst as cst

from ..types.scopes import OwnClass, Scope
from .edits import first_parameter, in_place_of, is_pass, renamed, with_last
from .file import FileRewriter

_CALL = "super().__init__()"


def rewrite(file: FileRewriter, own: OwnClass, method: cst.FunctionDef) -> None:
    """Rewrite a class's `robotInit`.

    A class without a constructor gets this one. In a class with one, that calls it as its last statement.
    """
    constructor = own.scope.bindings.get("__init__", [])
    node = constructor[0].node if constructor else None
    if not isinstance(node, cst.FunctionDef):
        file.edit(method, renamed("__init__"))
        if not _calls_super(method):
            file.edit(method, lambda updated: _with_first(updated, _CALL))
        file.say(method, "robotInit is the constructor now.", done=True)
        return
    name = "robot_init"
    file.edit(method, renamed(name))
    first = first_parameter(node) or "self"
    call = cst.ensure_type(cst.parse_statement(f"{first}.{name}()"), cst.SimpleStatementLine)
    above = file.inference.lineage(own)[0][1:]
    twice = next((each for each in above if {"__init__", "robotInit"} <= each.scope.bindings.keys()), None)
    if twice is None:
        file.edit(node, lambda updated: with_last(updated, call))
    else:
        what = f"robotInit is called {name} now, by the constructor of {twice.name}: before the rest of {own.name}'s."
        file.say(method, what, "What it needs of that belongs above super().__init__().")
        return
    file.say(method, f"robotInit is called {name} now, by the constructor.", done=True)


def super_call(file: FileRewriter, node: cst.Call, scope: Scope) -> bool:
    """Rewrite `super().robotInit()` in what becomes a constructor. Return whether it is that."""
    function = scope.function
    own = function.own_class if function is not None else None
    if own is None or function is None or function.name != "robotInit" or not _is_super(node):
        return False
    if own.scope.bindings.get("__init__"):
        return False
    file.handled.add(node.func)
    file.edit(node.func, lambda updated: updated.with_changes(attr=cst.Name("__init__")))
    return True


def _is_super(node: cst.CSTNode) -> bool:
    return (
        isinstance(node, cst.Call)
        and isinstance(node.func, cst.Attribute)
        and node.func.attr.value == "robotInit"
        and isinstance(node.func.value, cst.Call)
        and isinstance(node.func.value.func, cst.Name)
        and node.func.value.func.value == "super"
    )


def _calls_super(method: cst.FunctionDef) -> bool:
    class Finder(cst.CSTVisitor):
        found = False

        def visit_Call(self, node: cst.Call) -> None:
            self.found = self.found or _is_super(node)

    finder = Finder()
    method.body.visit(finder)
    return finder.found


def _with_first(method: Any, code: str) -> Any:
    statement: cst.BaseStatement = cst.parse_statement(code)
    body = method.body
    if isinstance(body, cst.SimpleStatementSuite):
        block = cst.IndentedBlock([statement, cst.SimpleStatementLine(body.body)], header=body.trailing_whitespace)
        return method.with_changes(body=block)
    statements = list(body.body)
    index = 1 if _is_docstring(statements[0]) else 0
    if len(statements) == index + 1 and is_pass(statements[index]):
        statement = in_place_of(statements.pop(), statement)
    return method.with_changes(body=body.with_changes(body=[*statements[:index], statement, *statements[index:]]))


def _is_docstring(statement: cst.BaseStatement) -> bool:
    return (
        isinstance(statement, cst.SimpleStatementLine)
        and isinstance(statement.body[0], cst.Expr)
        and isinstance(statement.body[0].value, cst.SimpleString | cst.ConcatenatedString)
    )
