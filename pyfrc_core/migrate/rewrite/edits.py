"""Apply edits to a tree: each belongs to a node, and gets it with the edits inside it already made."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, cast

import libcst as cst

Edit = Callable[[Any], Any]


class Apply(cst.CSTTransformer):
    """Make all edits.

    :param edits: by the node of the original tree
    :param statements: by an import statement: what replaces it; nothing removes it
    """

    def __init__(
        self,
        edits: Mapping[cst.CSTNode, Edit],
        statements: Mapping[cst.CSTNode, list[cst.BaseSmallStatement]] | None = None,
    ) -> None:
        self._edits = edits
        self._statements = statements or {}
        #: How many edits were made before each of the statements around.
        self._made = 0
        self._before: list[int] = []

    def on_visit(self, node: cst.CSTNode) -> bool:
        """Note where a statement begins."""
        if isinstance(node, cst.BaseStatement):
            self._before.append(self._made)
        return super().on_visit(node)

    def on_leave(self, original_node: Any, updated_node: Any) -> Any:
        """Replace a node that has an edit; what a statement loses of its comments stands before it then."""
        updated = super().on_leave(original_node, updated_node)
        if original_node in self._edits:
            self._made += 1
            updated = self._edits[original_node](updated)
        if isinstance(original_node, cst.BaseStatement) and self._before.pop() < self._made:
            there = _comments(updated)
            lost = [each for each in _comments(original_node) if each not in there]
            updated = commented(lost)(updated) if lost else updated
        return updated

    def leave_SimpleStatementLine(
        self, original_node: cst.SimpleStatementLine, updated_node: cst.SimpleStatementLine
    ) -> Any:
        """Replace the import statements of a line; what has become several statements has a line for each."""
        if len(original_node.body) == 1 and len(updated_node.body) > 1:
            first, *others = updated_node.body
            rest = [cst.SimpleStatementLine([_without_semicolon(each)]) for each in others]
            return cst.FlattenSentinel([updated_node.with_changes(body=[_without_semicolon(first)]), *rest])
        if not any(each in self._statements for each in original_node.body):
            return updated_node
        body: list[cst.BaseSmallStatement] = []
        for original, updated in zip(original_node.body, updated_node.body, strict=True):
            body += self._statements.get(original, [updated])
        if not body:
            return cst.RemoveFromParent()
        if len(original_node.body) > 1:
            return updated_node.with_changes(body=[_without_semicolon(each) for each in body])
        lines: list[cst.BaseStatement] = [updated_node.with_changes(body=[body[0]])]
        lines += [cst.SimpleStatementLine([each]) for each in body[1:]]
        return cst.FlattenSentinel(lines)


class _Comments(cst.CSTVisitor):
    def __init__(self) -> None:
        self.found: list[str] = []

    def visit_Comment(self, node: cst.Comment) -> None:
        self.found.append(node.value)

    def visit_IndentedBlock(self, node: cst.IndentedBlock) -> bool:
        node.header.visit(self)
        return False  # its statements have their own


def _comments(node: Any) -> list[str]:
    """Return the comments of a statement, without those of the statements inside."""
    visitor = _Comments()
    for each in node if isinstance(node, cst.FlattenSentinel) else [node]:
        if isinstance(each, cst.CSTNode):
            each.visit(visitor)
    return visitor.found


def _without_semicolon(node: cst.BaseSmallStatement) -> cst.BaseSmallStatement:
    return node.with_changes(semicolon=cst.MaybeSentinel.DEFAULT)


def renamed(new: str) -> Edit:
    """Return an edit that gives a name, attribute, keyword or definition a new name."""

    def edit(node: Any) -> Any:
        if isinstance(node, cst.Attribute):
            return node.with_changes(attr=cst.Name(new))
        if isinstance(node, cst.Name):
            return node.with_changes(value=new)
        return node.with_changes(name=cst.Name(new))

    return edit


def changed(**changes: Any) -> Edit:
    """Return an edit that changes parts of a node."""
    return lambda updated: updated.with_changes(**changes)


def replaced(new: cst.CSTNode) -> Edit:
    """Return an edit that puts a node in the place of another one."""
    return lambda updated: new


def commented(texts: list[str]) -> Edit:
    """Return an edit that puts comments before a statement, but for those that it has; before what replaces it, too."""

    def edit(node: Any) -> Any:
        if isinstance(node, cst.FlattenSentinel):
            first, *others = node
            return cst.FlattenSentinel([edit(first), *others])
        if not isinstance(node, cst.CSTNode) or not hasattr(node, "leading_lines"):
            return node
        there = {each.comment.value for each in node.leading_lines if each.comment is not None}
        new = [cst.EmptyLine(comment=cst.Comment(each)) for each in texts if each not in there]
        return node.with_changes(leading_lines=[*node.leading_lines, *new])

    return edit


def with_last(method: cst.FunctionDef, statement: cst.BaseStatement) -> cst.FunctionDef:
    """Return a function with one more statement at its end; it takes the place of a `pass`."""
    body = method.body
    if isinstance(body, cst.SimpleStatementSuite):
        block = cst.IndentedBlock([cst.SimpleStatementLine(body.body), statement], header=body.trailing_whitespace)
        return method.with_changes(body=block)
    before = [*body.body]
    if before and is_pass(before[-1]):
        statement = in_place_of(before.pop(), statement)
    return method.with_changes(body=body.with_changes(body=[*before, statement]))


def in_place_of(old: cst.BaseStatement, new: cst.BaseStatement) -> cst.BaseStatement:
    """Return a statement with the comments of the `pass` whose place it takes, after its own."""
    old, new = cst.ensure_type(old, cst.SimpleStatementLine), cst.ensure_type(new, cst.SimpleStatementLine)
    lines = [*new.leading_lines, *old.leading_lines]
    return new.with_changes(leading_lines=lines, trailing_whitespace=old.trailing_whitespace)


def first_parameter(function: cst.FunctionDef | cst.Lambda) -> str:
    """Return the name of a function's first parameter; "" if it has none."""
    parameters = function.params.params
    return parameters[0].name.value if parameters else ""


def is_pass(statement: cst.CSTNode) -> bool:
    """Return whether a statement is `pass`."""
    return isinstance(statement, cst.SimpleStatementLine) and isinstance(statement.body[0], cst.Pass)


def chain(path: str) -> cst.Name | cst.Attribute:
    """Return the expression `a.b.c`."""
    first, *rest = path.split(".")
    node: cst.Name | cst.Attribute = cst.Name(first)
    for each in rest:
        node = cst.Attribute(node, cst.Name(each))
    return node


def fill(text: str, parts: Mapping[str, cst.BaseExpression], call: cst.Call | None = None) -> cst.BaseExpression:
    """Return an expression from a text with `{0}`, `{self}` and the like, and `{args}` for all arguments of a call."""
    prepared = re.sub(r"\{(\w+)\}", r"part_\1_", text)
    tree = cst.parse_expression(prepared)
    return standing_alone(cast("cst.BaseExpression", tree.visit(_Fill(parts, call))))


def standing_alone(node: cst.BaseExpression) -> cst.BaseExpression:
    """Return an expression that can stand where it has no parentheses around it: of several lines, it has its own."""
    code = cst.Module([]).code_for_node(node)
    try:
        if "\n" in code:
            cst.parse_expression(code)
    except cst.ParserSyntaxError:
        return node.with_changes(lpar=[cst.LeftParen()], rpar=[cst.RightParen()])
    return node


class _Fill(cst.CSTTransformer):
    def __init__(self, parts: Mapping[str, cst.BaseExpression], call: cst.Call | None) -> None:
        self._parts = parts
        self._call = call

    def leave_Call(self, original_node: cst.Call, updated_node: cst.Call) -> cst.Call:
        args = original_node.args
        name = args[0].value.value if len(args) == 1 and isinstance(args[0].value, cst.Name) else ""
        if name == "part_args_" and self._call is not None:
            space = self._call.whitespace_before_args
            return updated_node.with_changes(args=self._call.args, whitespace_before_args=space)
        return updated_node

    def leave_Attribute(self, original_node: cst.Attribute, updated_node: cst.Attribute) -> cst.Attribute:
        return updated_node.with_changes(value=self._operand(original_node.value, updated_node.value))

    def leave_BinaryOperation(
        self, original_node: cst.BinaryOperation, updated_node: cst.BinaryOperation
    ) -> cst.BinaryOperation:
        left = self._operand(original_node.left, updated_node.left)
        right = self._operand(original_node.right, updated_node.right)
        return updated_node.with_changes(left=left, right=right)

    def _operand(self, before: cst.BaseExpression, after: cst.BaseExpression) -> cst.BaseExpression:
        return in_parentheses(after) if isinstance(before, cst.Name) else after

    def leave_Name(self, original_node: cst.Name, updated_node: cst.Name) -> cst.BaseExpression:
        key = original_node.value
        if not (key.startswith("part_") and key.endswith("_")) or key[5:-1] not in self._parts:
            return updated_node
        return self._parts[key[5:-1]]


def in_parentheses(node: cst.BaseExpression) -> cst.BaseExpression:
    """Return an expression that can stand before an operator, with parentheses if it needs them."""
    simple = cst.Name | cst.Attribute | cst.Call | cst.Subscript | cst.Integer | cst.Float | cst.SimpleString
    if isinstance(node, simple) or node.lpar:
        return node
    return node.with_changes(lpar=[cst.LeftParen()], rpar=[cst.RightParen()])
