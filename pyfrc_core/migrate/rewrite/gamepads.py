"""What became of gamepads: the numbers of an Xbox controller's axes and buttons, the deadband of sticks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import libcst as cst

from ..names.table import Table
from ..types.atoms import Bound, Obj, Ref
from ..types.scopes import Module, Scope
from ..types.values import Types, written_number
from .file import FileRewriter

_HIDS = {"wpilib.interfaces.GenericHID", "commands2.button.CommandGenericHID"}


def xbox_ports(modules: Iterable[Module], inference: Types, table: Table) -> frozenset[int]:
    """Return the ports at which a project's code has an Xbox controller and nothing else."""
    xbox: set[int] = set()
    others: set[int] = set()
    for module in modules:
        for node, scope in module.sites:
            if not isinstance(node, cst.Call) or not node.args:
                continue
            made = [each.path for each in inference.infer(node.func, scope) if isinstance(each, Ref)]
            if any(_HIDS.intersection(table.ancestors(path)) for path in made):
                port = written_number(inference, node.args[0].value, scope)
                if port is not None:
                    (xbox if made[0] in table.corrections["xbox"]["classes"] else others).add(port)
    return frozenset(xbox - others)


def xbox_number(corrections: Mapping[str, Any], kind: str, number: int) -> int | None:
    """Return the new number of an axis or a button of an Xbox controller; None if it has no such one.

    :param kind: `axes` or `buttons`
    """
    found = corrections["xbox"][kind].get(str(number))
    return None if found is None else int(found)


class Sticks:
    """The sticks that a file's code reads, which have a deadband of their own now."""

    def __init__(self, rewriter: FileRewriter) -> None:
        self._file = rewriter
        self._deadband: Mapping[str, Any] = rewriter.table.corrections["deadband"]

    def call(self, node: cst.Call, scope: Scope, path: str) -> None:
        """Report a gamepad, and leave out a deadband that is the same as the new one.

        :param path: what is called
        """
        if path in self._deadband["classes"]:
            self._file.say(node, f"{path} has a deadband now.", self._deadband["note"], done=True)
        if path != "wpimath.applyDeadband" or not node.args or not self._is_stick(node.args[0].value, scope):
            return
        width = node.args[1].value if len(node.args) == 2 else None
        if isinstance(width, cst.Float) and width.evaluated_value == self._deadband["width"]:
            self._file.consume(node.func, scope)
            self._file.edit(node, lambda updated: updated.args[0].value)
        else:
            self._file.say(node, "The stick has a deadband of its own now.", self._deadband["note"], done=True)

    def _is_stick(self, node: cst.BaseExpression, scope: Scope) -> bool:
        return isinstance(node, cst.Call) and any(
            isinstance(each, Bound)
            and each.name in self._deadband["sticks"]
            and isinstance(each.receiver, Obj)
            and each.receiver.path in self._deadband["classes"]
            for each in self._file.inference.infer(node.func, scope)
        )
