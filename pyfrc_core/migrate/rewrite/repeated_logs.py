"""Log again and again what WPILib 2026 sent to dashboards by itself.

`SmartDashboard.putData` moves from a constructor to the end of a periodic method.
"""

from __future__ import annotations

import libcst as cst

from ..types.scopes import OwnClass, OwnFunction, Scope
from .edits import first_parameter, with_last
from .file import FileRewriter

_ONCE = {"__init__", "robotInit", "createObjects"}
_PERIODIC = {
    "wpilib.IterativeRobotBase": "robotPeriodic",
    "magicbot.MagicRobot": "robotPeriodic",
    "commands2.Subsystem": "periodic",
}


class RepeatedLogs:
    """The calls of a file that can move."""

    def __init__(self, rewriter: FileRewriter) -> None:
        self._file = rewriter

    def move(self, node: cst.Call, scope: Scope, arguments: str) -> bool:
        """Move a call if it is a statement of its own that shows an attribute. Return whether it has been moved.

        :param node: the call; the last of its arguments is what it shows
        :param arguments: what the new call gets, as code
        """
        function = scope.function
        own = function.own_class if function is not None else None
        if function is None or own is None or function.name not in _ONCE:
            return False
        line = _line_of(node, function)
        periodic = self._periodic(own, first_parameter(function.node))
        shown = node.args[-1].value
        if line is None or periodic is None or not _is_own(shown, first_parameter(function.node)):
            return False
        root = self._file.consume(node.func, scope)
        code = f"{self._file.imports.spell('telemetry.log', root, scope)}({arguments})"
        comments = [each for each in line.leading_lines if each.comment is not None]
        new = cst.ensure_type(cst.parse_statement(code), cst.SimpleStatementLine).with_changes(leading_lines=comments)
        self._file.remove(cst.ensure_type(line.body[0], cst.Expr))
        self._file.edit(periodic, lambda updated: with_last(updated, new))
        return True

    def _periodic(self, own: OwnClass, parameter: str) -> cst.FunctionDef | None:
        """Return the class's own method that is called again and again, if it always runs to its end."""
        bases = {each for path in self._file.inference.lineage(own)[1] for each in self._file.table.ancestors(path)}
        for base, name in _PERIODIC.items():
            methods = [each.node for each in own.scope.bindings.get(name, ())] if base in bases else []
            if len(methods) == 1 and isinstance(methods[0], cst.FunctionDef):
                method = methods[0]
                finder = _Returns()
                method.visit(finder)
                if not finder.found and first_parameter(method) == parameter:
                    return method
        return None


class _Returns(cst.CSTVisitor):
    found = False

    def visit_Return(self, node: cst.Return) -> None:
        self.found = True


def _line_of(node: cst.Call, function: OwnFunction) -> cst.SimpleStatementLine | None:
    """Return the line of a call that is a statement of its own, not in a branch or loop."""
    for each in function.node.body.body if isinstance(function.node.body, cst.IndentedBlock) else ():
        if isinstance(each, cst.SimpleStatementLine) and len(each.body) == 1:
            statement = each.body[0]
            if isinstance(statement, cst.Expr) and statement.value is node:
                return each
    return None


def _is_own(node: cst.BaseExpression, parameter: str) -> bool:
    """Return whether an expression is an attribute such as `self.field`."""
    return isinstance(node, cst.Attribute) and isinstance(node.value, cst.Name) and node.value.value == parameter
