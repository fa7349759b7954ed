"""The new text of a file, when all of its edits are known: imports, string annotations, comments."""

from __future__ import annotations

from typing import cast

import libcst as cst

from ..types.scopes import Scope
from .edits import Apply, changed
from .file import FileRewriter


def rewrite_annotation(file: FileRewriter, node: cst.SimpleString, scope: Scope) -> None:
    """Rewrite an annotation that is a string."""
    text = str(node.evaluated_value)
    try:
        tree = cst.parse_expression(text)
    except cst.ParserSyntaxError:
        return
    file.default_line = file.line(node)
    parts = _Parts()
    tree.visit(parts)
    for each in parts.attributes:
        file.attribute(each, scope)
    for name in parts.names:
        file.name(name, scope)
    file.default_line = 1
    new = cast("cst.BaseExpression", tree.visit(Apply(file.edits)))
    code = cst.Module([]).code_for_node(new)
    if code != text:
        file.edit(node, changed(value=f"{node.prefix}{node.quote}{code}{node.quote}"))


def new_text(file: FileRewriter) -> str:
    """Return the file's new text."""
    statements = file.imports.plan()
    statements |= {each: [] for each in file.removed}
    file.replaced = frozenset(statements)
    tree = file.module.tree.visit(Apply(file.edits, statements))
    assert isinstance(tree, cst.Module)
    if file.imports.at_top:
        lines = [cst.SimpleStatementLine([each]) for each in file.imports.at_top]
        index = _after_docstring(tree)
        tree = tree.with_changes(body=[*tree.body[:index], *lines, *tree.body[index:]])
    # A form feed in front of the first indentation of a file would be in each new block, and end the one around it.
    return tree.with_changes(default_indent=tree.default_indent.replace("\f", "")).code


class _Parts(cst.CSTVisitor):
    def __init__(self) -> None:
        self.attributes: list[cst.Attribute] = []
        self.names: list[cst.Name] = []

    def visit_Attribute(self, node: cst.Attribute) -> bool:
        self.attributes.append(node)
        node.value.visit(self)
        return False

    def visit_Name(self, node: cst.Name) -> None:
        self.names.append(node)


def _after_docstring(tree: cst.Module) -> int:
    index = 0
    for line in tree.body:
        if not isinstance(line, cst.SimpleStatementLine):
            break
        first = line.body[0]
        is_text = isinstance(first, cst.Expr) and isinstance(first.value, cst.SimpleString | cst.ConcatenatedString)
        is_future = (
            isinstance(first, cst.ImportFrom)
            and isinstance(first.module, cst.Name)
            and first.module.value == "__future__"
        )
        if not (is_text or is_future):
            break
        index += 1
    return index
