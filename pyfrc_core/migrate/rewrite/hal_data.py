"""Rewrite the numbers of buttons in `hal_data`, which are those that robot code gives them."""

from __future__ import annotations

import libcst as cst

from ..types.scopes import Scope
from ..types.values import values
from .edits import changed, in_parentheses
from .file import FileRewriter


class HalData:
    """The buttons that a file's tests and physics press in `hal_data`."""

    def __init__(self, rewriter: FileRewriter) -> None:
        self._file = rewriter
        self._with_number: set[cst.CSTNode] = set()

    def subscript(self, node: cst.Subscript, scope: Scope) -> None:
        """Count a button from 0: `hal_data["joysticks"][0]["buttons"][1]` becomes `...["buttons"][0]`."""
        if not self._file.first_time:
            return
        index = _index(node)
        if index is not None and self._is_part(node.value, scope, "axes") and not _is_first(index.value):
            self._file.say(
                node,
                "The axes of a gamepad have other numbers.",
                "Of an Xbox controller, 2 is 4, 3 is 5, 4 is 2 and 5 is 3; a button's number may differ, too.",
                done=True,
            )
        if self._is_buttons(node, scope):
            if node not in self._with_number:
                self._file.say(
                    node, "Buttons count from 0 in hal_data, too.", "Check what is done with this list.", done=True
                )
            return
        index = _index(node)
        if index is None or not self._is_buttons(node.value, scope):
            return
        self._with_number.add(node.value)
        number = index.value
        if isinstance(number, cst.Integer):
            if number.evaluated_value:
                self._file.edit(index, changed(value=cst.Integer(str(number.evaluated_value - 1))))
        elif not isinstance(number, cst.Attribute):  # that is a constant of an enumeration
            self._file.edit(
                index,
                lambda updated: updated.with_changes(
                    value=cst.BinaryOperation(in_parentheses(updated.value), cst.Subtract(), cst.Integer("1"))
                ),
            )
            self._file.say(node, "Buttons count from 0 in hal_data, too: 1 is subtracted here.", done=True)

    def _is_buttons(self, node: cst.BaseExpression, scope: Scope) -> bool:
        return self._is_part(node, scope, "buttons")

    def _is_part(self, node: cst.BaseExpression, scope: Scope, key: str) -> bool:
        index = _index(node)
        return (
            isinstance(node, cst.Subscript)
            and index is not None
            and isinstance(index.value, cst.SimpleString)
            and index.value.evaluated_value == key
            and self._is_hal_data(node.value, scope, set())
        )

    def _is_hal_data(self, node: cst.CSTNode, scope: Scope, seen: set[str]) -> bool:
        """Return whether an expression is `hal_data`, or a part of it."""
        while isinstance(node, cst.Subscript):
            node = node.value
        if isinstance(node, cst.Attribute):
            return node.attr.value == "hal_data"
        if not isinstance(node, cst.Name) or node.value in seen:
            return False
        if node.value == "hal_data":
            return True
        seen.add(node.value)
        found = values(self._file.inference, node, scope)
        return bool(found) and all(self._is_hal_data(each, scope, seen) for each in found)


def _index(node: cst.BaseExpression) -> cst.Index | None:
    """Return the one index of a subscript."""
    if not isinstance(node, cst.Subscript) or len(node.slice) != 1:
        return None
    index = node.slice[0].slice
    return index if isinstance(index, cst.Index) and index.star is None else None


def _is_first(number: cst.BaseExpression) -> bool:
    """Return whether a number is that of the left stick, which has not changed."""
    return isinstance(number, cst.Integer) and number.evaluated_value < 2
