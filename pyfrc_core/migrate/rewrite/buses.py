"""Rewrite how CAN devices name their bus, which was the roboRIO's one where nothing was said."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import libcst as cst

from ..types.atoms import Obj
from ..types.scopes import Scope
from ..types.values import values
from .edits import changed, fill
from .file import FileRewriter

_CTRE = "phoenix6.CANBus"
_EQUAL = cst.AssignEqual(cst.SimpleWhitespace(""), cst.SimpleWhitespace(""))
_OURS = ("", "rio")  # what phoenix6 calls the controller's own bus


class Buses:
    """The buses of a file's CAN devices."""

    def __init__(self, rewriter: FileRewriter) -> None:
        self._file = rewriter
        self._corrections: Mapping[str, Any] = rewriter.table.corrections["can_bus"]

    def device(self, node: cst.Call, scope: Scope, path: str) -> bool:
        """Name the bus, if a call makes a CAN device or a bus.

        :param path: what is called
        """
        if path in self._corrections["classes"]:
            self._put_first(node, scope)
        elif path in self._corrections["after_id"]:
            self._put_after_id(node, scope)
        elif path == _CTRE:
            self._bus(node, scope)
        else:
            return False
        return True

    def _put_first(self, node: cst.Call, scope: Scope) -> None:
        bus = self._port(node, scope)
        self._file.edit(node, lambda updated: updated.with_changes(args=[_first(bus, updated), *updated.args]))
        self._say_first(node)

    def _put_after_id(self, node: cst.Call, scope: Scope) -> None:
        """Pass a phoenix6.CANBus where a device of CTRE's has no bus, or the name of one."""
        by_keyword = any(arg.keyword for arg in node.args)
        given = [arg for arg in node.args if arg.keyword is not None and arg.keyword.value == "canbus"]
        given += [arg for arg in node.args[1:2] if arg.keyword is None]
        if any(arg.star for arg in node.args):
            self._file.say(node, "A device of CTRE's takes a phoenix6.CANBus as its second argument.", "Check it.")
            return
        if not given:
            bus = self._spelled(f"<{_CTRE}>(<{self._corrections['bus']}>)", node, scope)
            new = cst.Arg(bus, cst.Name("canbus"), _EQUAL) if by_keyword else cst.Arg(bus)
            self._file.edit(node, lambda updated: updated.with_changes(args=[*updated.args, new]))
            self._say_first(node)
            return
        types = self._file.inference.infer(given[0].value, scope)
        if any(isinstance(each, Obj) and each.path == _CTRE for each in types):
            return
        names = self._names(given[0].value, scope)
        if not names:
            self._file.say(
                node, "A device of CTRE's takes a phoenix6.CANBus, not its name.", "Pass phoenix6.CANBus(name) here."
            )
        elif names & set(_OURS):
            bus = self._spelled(f"<{_CTRE}>(<{self._corrections['bus']}>)", node, scope)
            self._file.edit(given[0], changed(value=bus))
            self._say_first(node)
        else:
            text = self._text(f"<{_CTRE}>({{0}})", node, scope)
            self._file.edit(given[0], lambda updated: updated.with_changes(value=fill(text, {"0": updated.value})))

    def _bus(self, node: cst.Call, scope: Scope) -> None:
        """Name the port where a phoenix6.CANBus is the controller's own."""
        names = self._names(node.args[0].value, scope) if node.args else {""}
        if names and names <= set(_OURS):
            port = self._port(node, scope)
            self._file.edit(node, changed(args=[cst.Arg(port)]))
            self._say_first(node)
        elif node.args:
            self._file.edit(node, lambda updated: updated.with_changes(args=[cst.Arg(updated.args[0].value)]))
        if len(node.args) > 1:
            self._file.say(
                node,
                "A phoenix6.CANBus takes no hoot file any more, so it is left out here.",
                "To replay one, make a phoenix6.HootReplay of it before the devices.",
                done=True,
            )

    def _names(self, node: cst.BaseExpression, scope: Scope) -> set[str]:
        """Return the texts that an expression can be; nothing if it can be something else."""
        found = [node] if isinstance(node, cst.SimpleString) else values(self._file.inference, node, scope)
        texts = {str(each.evaluated_value) for each in found if isinstance(each, cst.SimpleString)}
        return texts if all(isinstance(each, cst.SimpleString) for each in found) else set()

    def _port(self, node: cst.Call, scope: Scope) -> cst.BaseExpression:
        return self._spelled(f"<{self._corrections['bus']}>", node, scope)

    def _spelled(self, text: str, node: cst.Call, scope: Scope) -> cst.BaseExpression:
        return cst.parse_expression(self._text(text, node, scope))

    def _text(self, text: str, node: cst.Call, scope: Scope) -> str:
        root = node.func
        while isinstance(root, cst.Attribute):
            root = root.value
        return self._file.imports.fill_in(text, root, scope)

    def _say_first(self, node: cst.Call) -> None:
        self._file.say(node, "A CAN device names its bus now.", self._corrections["note"], done=True)


def _first(value: cst.BaseExpression, call: cst.Call) -> cst.Arg:
    if not call.args:
        return cst.Arg(value)
    return cst.Arg(value, comma=cst.Comma(whitespace_after=cst.SimpleWhitespace(" ")))
