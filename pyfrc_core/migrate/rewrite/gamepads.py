"""What became of gamepads: the numbers of their axes and buttons, the deadband of their sticks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import libcst as cst

from ..names.table import Table
from ..types.atoms import Bound, Obj, Ref
from ..types.scopes import Module, Scope
from ..types.values import Types, written_number
from .file import FileRewriter

_HIDS = {"wpilib.interfaces.GenericHID", "commands2.button.CommandGenericHID"}


@dataclass(frozen=True)
class Gamepad:
    """A kind of gamepad, whose axes and buttons have other numbers now.

    :param name: as messages have it, such as "an Xbox controller"
    :param classes: the paths of its classes
    :param axes: the new number by the old one, as texts of digits
    :param buttons: the same, of the buttons that still have a number
    """

    name: str
    classes: tuple[str, ...]
    axes: Mapping[str, int] = field(hash=False)
    buttons: Mapping[str, int] = field(hash=False)

    def number(self, kind: str, old: int) -> int | None:
        """Return the new number of an axis or a button; None if it has no such one.

        :param kind: `axes` or `buttons`
        """
        return (self.axes if kind == "axes" else self.buttons).get(str(old))


def gamepad_of(table: Table, paths: Iterable[str]) -> Gamepad | None:
    """Return the gamepad that one of these classes is; None for others, such as a `Joystick`."""
    found = (each for each in table.corrections["gamepads"] if not set(paths).isdisjoint(each["classes"]))
    first = next(found, None)
    return None if first is None else Gamepad(first["name"], tuple(first["classes"]), first["axes"], first["buttons"])


def gamepads_by_port(modules: Iterable[Module], inference: Types, table: Table) -> Mapping[int, Gamepad]:
    """Return the gamepad at each port at which a project's code has one and nothing else."""
    found: dict[int, set[Gamepad | None]] = {}
    for module in modules:
        for node, scope in module.sites:
            if not isinstance(node, cst.Call) or not node.args:
                continue
            made = [each.path for each in inference.infer(node.func, scope) if isinstance(each, Ref)]
            if any(_HIDS.intersection(table.ancestors(path)) for path in made):
                port = written_number(inference, node.args[0].value, scope)
                if port is not None:
                    found.setdefault(port, set()).add(gamepad_of(table, made))
    return {port: each for port, (each, *others) in found.items() if each is not None and not others}


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
