"""Rewrite the numbers of axes and buttons in `hal_data`, which are those that robot code gives them; report keys."""

from __future__ import annotations

from collections.abc import Mapping

import libcst as cst

from ..types.scopes import Scope
from ..types.values import values, written_number
from .edits import changed
from .file import FileRewriter
from .gamepads import Gamepad, Numbers


class HalData:
    """What a file's tests and physics do with `hal_data`.

    :param gamepads: those that the project has, by their ports
    """

    def __init__(self, rewriter: FileRewriter, gamepads: Mapping[int, Gamepad]) -> None:
        self._file = rewriter
        self._gamepads = gamepads
        self._numbers = Numbers(rewriter)
        self._with_number: set[cst.CSTNode] = set()

    def subscript(self, node: cst.Subscript, scope: Scope) -> None:
        """Count a button from 0: `hal_data["joysticks"][0]["buttons"][1]` becomes `...["buttons"][0]`."""
        index = _index(node)
        if index is None or not self._file.first_time:
            return
        key = self._key(node, scope)
        if key is not None:
            self._said_by_key(node, key)
            return
        part = self._resolved(node.value, scope)
        if not isinstance(part, cst.Subscript):
            return
        key = self._key(part, scope)
        if key == "axes":
            self._axis(node, index, part, scope)
        elif key == "buttons":
            self._with_number.add(part)
            self._numbers.button(index, index.value, scope, {self._gamepad(part, scope)}, " in hal_data, too")

    def _said_by_key(self, node: cst.Subscript, key: str) -> None:
        advice = self._file.table.corrections["hal_data_gone"].get(key)
        if advice is not None:
            self._file.say(node, f'hal_data["{key}"] is gone.', advice)
        elif key == "buttons" and node not in self._with_number:
            self._file.say(
                node, "Buttons count from 0 in hal_data, too.", "Check what is done with this list.", done=True
            )

    def _axis(self, node: cst.Subscript, index: cst.Index, part: cst.Subscript, scope: Scope) -> None:
        old = written_number(self._file.inference, index.value, scope)
        if old is not None and old < 2:
            return  # of the left stick, which has not changed
        gamepad = self._gamepad(part, scope)
        new = gamepad.number("axes", old) if gamepad is not None and old is not None else None
        if new is not None and isinstance(index.value, cst.Integer):
            self._file.edit(index, changed(value=cst.Integer(str(new))))
            return
        self._file.say(
            node,
            "The axes of a gamepad have other numbers.",
            "Of an Xbox controller, 2 is 4, 3 is 5, 4 is 2 and 5 is 3; a button's number may differ, too.",
            done=True,
        )

    def _gamepad(self, part: cst.Subscript, scope: Scope) -> Gamepad | None:
        """Return the gamepad whose axes or buttons a part of `hal_data` is."""
        port = self._port(part.value, scope)
        return None if port is None else self._gamepads.get(port)

    def _port(self, joystick: cst.CSTNode, scope: Scope) -> int | None:
        """Return the port of a joystick of `hal_data`."""
        joystick = self._resolved(joystick, scope)
        if not isinstance(joystick, cst.Subscript) or self._key(joystick.value, scope) != "joysticks":
            return None
        index = _index(joystick)
        return None if index is None else written_number(self._file.inference, index.value, scope)

    def _resolved(self, node: cst.CSTNode, scope: Scope) -> cst.CSTNode:
        """Return what a name is given once, or another expression itself."""
        found = values(self._file.inference, node, scope) if isinstance(node, cst.Name) else []
        return found[0] if len(found) == 1 else node

    def _key(self, node: cst.CSTNode, scope: Scope) -> str | None:
        """Return the key that a subscript of `hal_data`, or of a part of it, names."""
        index = _index(node)
        if (
            isinstance(node, cst.Subscript)
            and index is not None
            and isinstance(index.value, cst.SimpleString)
            and self._is_hal_data(node.value, scope, set())
        ):
            return str(index.value.evaluated_value)
        return None

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


def _index(node: cst.CSTNode) -> cst.Index | None:
    """Return the one index of a subscript."""
    if not isinstance(node, cst.Subscript) or len(node.slice) != 1:
        return None
    index = node.slice[0].slice
    return index if isinstance(index, cst.Index) and index.star is None else None
