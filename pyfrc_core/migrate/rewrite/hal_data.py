"""Rewrite the numbers of buttons in `hal_data`, which are those that robot code gives them."""

from __future__ import annotations

import libcst as cst

from ..types.scopes import Scope
from ..types.values import values, written_number
from .edits import changed, in_parentheses
from .file import FileRewriter
from .gamepads import xbox_number


class HalData:
    """The axes and buttons that a file's tests and physics set in `hal_data`.

    :param xbox_ports: where the project has an Xbox controller
    """

    def __init__(self, rewriter: FileRewriter, xbox_ports: frozenset[int]) -> None:
        self._file = rewriter
        self._xbox_ports = xbox_ports
        self._with_number: set[cst.CSTNode] = set()

    def subscript(self, node: cst.Subscript, scope: Scope) -> None:
        """Count a button from 0: `hal_data["joysticks"][0]["buttons"][1]` becomes `...["buttons"][0]`."""
        if not self._file.first_time:
            return
        index = _index(node)
        if index is not None and self._is_part(node.value, scope, "axes") and not _is_first(index.value):
            self._axis(node, index, scope)
        if self._is_buttons(node, scope):
            if node not in self._with_number:
                self._file.say(
                    node, "Buttons count from 0 in hal_data, too.", "Check what is done with this list.", done=True
                )
            return
        if index is None or not self._is_buttons(node.value, scope):
            return
        self._with_number.add(node.value)
        number = index.value
        if isinstance(number, cst.Integer):
            new = self._of_xbox(node.value, scope, "buttons", number.evaluated_value)
            if number.evaluated_value:
                new = number.evaluated_value - 1 if new is None else new
                self._file.edit(index, changed(value=cst.Integer(str(new))))
        elif not isinstance(number, cst.Attribute):  # that is a constant of an enumeration
            self._file.edit(
                index,
                lambda updated: updated.with_changes(
                    value=cst.BinaryOperation(in_parentheses(updated.value), cst.Subtract(), cst.Integer("1"))
                ),
            )
            self._file.say(node, "Buttons count from 0 in hal_data, too: 1 is subtracted here.", done=True)

    def _axis(self, node: cst.Subscript, index: cst.Index, scope: Scope) -> None:
        number = index.value
        if isinstance(number, cst.Integer):
            new = self._of_xbox(node.value, scope, "axes", number.evaluated_value)
            if new is not None:
                self._file.edit(index, changed(value=cst.Integer(str(new))))
                return
        self._file.say(
            node,
            "The axes of a gamepad have other numbers.",
            "Of an Xbox controller, 2 is 4, 3 is 5, 4 is 2 and 5 is 3; a button's number may differ, too.",
            done=True,
        )

    def _of_xbox(self, part: cst.BaseExpression, scope: Scope, kind: str, number: int) -> int | None:
        """Return the new number of an axis or a button, if it is one of an Xbox controller.

        :param part: the axes or the buttons of a joystick
        """
        if not isinstance(part, cst.Subscript) or self._port(part.value, scope) not in self._xbox_ports:
            return None
        return xbox_number(self._file.table.corrections, kind, number)

    def _port(self, joystick: cst.CSTNode, scope: Scope) -> int | None:
        """Return the port of a joystick of `hal_data`."""
        if isinstance(joystick, cst.Name):
            found = values(self._file.inference, joystick, scope)
            joystick = found[0] if len(found) == 1 else joystick
        if not isinstance(joystick, cst.Subscript) or not self._is_part(joystick.value, scope, "joysticks"):
            return None
        index = _index(joystick)
        return None if index is None else written_number(self._file.inference, index.value, scope)

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
