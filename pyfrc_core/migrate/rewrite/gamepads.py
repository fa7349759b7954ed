"""What became of gamepads: the numbers of their axes and buttons, the deadband of their sticks."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import libcst as cst

from ...season.names.table import Table
from ..types.atoms import Bound, Obj, Ref
from ..types.scopes import Module, Scope
from ..types.values import Types, written_number
from .edits import changed, in_parentheses, standing_alone
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


class Numbers:
    """The numbers of buttons and axes in a file."""

    def __init__(self, rewriter: FileRewriter) -> None:
        self._file = rewriter

    def button(
        self,
        holder: cst.Arg | cst.Index,
        value: cst.BaseExpression,
        scope: Scope,
        gamepads: Collection[Gamepad | None],
        where: str = "",
    ) -> None:
        """Write a button's new number.

        :param holder: what has the number
        :param gamepads: of which the button can be; None for other devices, whose buttons only count from 0 now
        :param where: for messages
        """
        if self._is_constant(value, scope):
            return
        gamepad = next(iter(gamepads), None)
        if gamepad is not None or len(gamepads) > 1:
            self._of_gamepad(holder, value, scope, gamepads, "buttons", where)
        elif isinstance(value, cst.Integer):
            self._file.edit(holder, changed(value=cst.Integer(str(max(0, value.evaluated_value - 1)))))
        else:
            self._subtract(holder, where)

    def axis(
        self, holder: cst.Arg | cst.Index, value: cst.BaseExpression, scope: Scope, gamepads: Collection[Gamepad | None]
    ) -> None:
        """Write an axis's new number; only those of gamepads have another one."""
        if any(each is not None for each in gamepads) and not self._is_constant(value, scope):
            self._of_gamepad(holder, value, scope, gamepads, "axes", "")

    def _is_constant(self, value: cst.BaseExpression, scope: Scope) -> bool:
        """Return whether a number is a constant of an enumeration."""
        is_value = isinstance(value, cst.Attribute) and value.attr.value == "value"
        return is_value or bool(self._file.inference.infer(value, scope))

    def _of_gamepad(
        self,
        holder: cst.Arg | cst.Index,
        value: cst.BaseExpression,
        scope: Scope,
        gamepads: Collection[Gamepad | None],
        kind: str,
        where: str,
    ) -> None:
        gamepad = next(each for each in gamepads if each is not None)
        old = written_number(self._file.inference, value, scope)
        new = gamepad.number(kind, old) if old is not None and len(gamepads) == 1 else None
        if isinstance(value, cst.Integer) and new is not None:
            self._file.edit(holder, changed(value=cst.Integer(str(new))))
        elif kind == "axes" and old is not None and new == old:
            return
        elif kind == "buttons" and old is not None and new == old - 1:
            self._subtract(holder, where)
        elif new is not None:
            one = f"{'Button' if kind == 'buttons' else 'Axis'} {old} of {gamepad.name} is {new} now."
            self._file.say(holder, one, f"Write {new} for {old}.")
        else:
            numbers = {int(each): number for each, number in getattr(gamepad, kind).items()}
            code = cst.Module([]).code_for_node(value)
            what = f"The {kind} of {gamepad.name} have other numbers{where}."
            self._file.say(holder, what, f"Write {numbers}[{code}] for {code}, if that is its old number.")

    def _subtract(self, holder: cst.Arg | cst.Index, where: str) -> None:
        def edit(updated: Any) -> Any:
            less = cst.BinaryOperation(in_parentheses(updated.value), cst.Subtract(), cst.Integer("1"))
            return updated.with_changes(value=less)

        self._file.edit(holder, edit)
        what = f"Buttons count from 0 now{where}: 1 is subtracted here."
        self._file.say(holder, what, "Better subtract it from the constant.", done=True)


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
            self._file.edit(node, lambda updated: standing_alone(updated.args[0].value))
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
