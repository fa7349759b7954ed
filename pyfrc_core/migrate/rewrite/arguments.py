"""Rewrite the arguments of calls: keywords, numbers of buttons, directions, buses, channels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import libcst as cst

from ..types.atoms import Many, Obj, Ref
from ..types.scopes import Scope
from ..types.values import values, written_number
from .buses import Buses
from .edits import changed, fill
from .file import FileRewriter
from .gamepads import Gamepad, Numbers, gamepad_of
from .lookup import Found
from .ports import Ports

_ENCODER = "wpilib.Encoder"
_GENERIC_HID = "wpilib.interfaces.GenericHID"


class Arguments:
    """The arguments of a file's calls.

    :param led_lists: the lists that become buffers
    :param ports: of the project's devices
    """

    def __init__(self, rewriter: FileRewriter, led_lists: frozenset[cst.CSTNode], ports: Ports) -> None:
        self._file = rewriter
        self._led_lists = led_lists
        self._ports = ports
        self._buses = Buses(rewriter)
        self._numbers = Numbers(rewriter)
        self._corrections: Mapping[str, Any] = rewriter.table.corrections

    def changed_meaning(self, node: cst.Call, scope: Scope, paths: list[str]) -> None:
        """Rewrite arguments that mean something else now.

        :param paths: what is called: the method, in its class and in the bases
        """
        for path in paths:
            if path in self._corrections["buttons"]:
                self._button(node, scope, self._corrections["buttons"][path])
            if path in self._corrections["axes"]:
                self._axis(node, scope, self._corrections["axes"][path])
            if path in self._corrections["pov_arguments"]:
                self._direction(node, self._corrections["pov_arguments"][path])
            if path in self._corrections["hid_arguments"]:
                self._hid(node, scope, self._corrections["hid_arguments"][path])
            for position in self._corrections["channel_arguments"].get(path, ()):
                self._channel(node, scope, position)
            if path in self._corrections["chooser_names"] and node.args:
                self._chooser(node.args[0], self._corrections["chooser_names"][path])
            if path in self._corrections["other_arguments"]:
                self._file.say(node, f"{path} takes other arguments.", self._corrections["other_arguments"][path])
            if path in self._corrections["no_lists"] and node.args:
                types = self._file.inference.infer(node.args[0].value, scope)
                made = values(self._file.inference, node.args[0].value, scope)
                is_buffer = bool(made) and self._led_lists.issuperset(made)
                if any(isinstance(each, Many) for each in types) and not is_buffer:
                    self._file.say(node, f"{path} takes no list any more.", self._corrections["no_lists"][path])
            if path in self._corrections["by_channel"] and node.args:
                self._by_channel(node, scope, self._corrections["by_channel"][path])
            if self._ports.kind(path):
                self._note_ports(node, scope, path)
            if path in self._corrections["channels"]:
                self._limit(node, scope, self._corrections["channels"][path])
            if self._buses.device(node, scope, path):
                break

    def keywords(self, node: cst.Call, found: Found) -> None:
        """Rename the keywords of a call."""
        member = found.member
        if member is None or member.new is None:
            return
        for arg in node.args:
            if arg.keyword is None:
                continue
            new = member.keyword(arg.keyword.value)
            if new == "-":
                self._file.say(arg.keyword, f"{found.path} has no argument {arg.keyword.value} any more.")
            elif new != arg.keyword.value:
                self._file.edit(arg, changed(keyword=cst.Name(new)))

    def _button(self, node: cst.Call, scope: Scope, position: int) -> None:
        if len(node.args) > position and not node.args[position].star:
            arg = node.args[position]
            self._numbers.button(arg, arg.value, scope, self._gamepads(node, scope))

    def _axis(self, node: cst.Call, scope: Scope, position: int) -> None:
        if len(node.args) > position and not node.args[position].star:
            arg = node.args[position]
            self._numbers.axis(arg, arg.value, scope, self._gamepads(node, scope))

    def _gamepads(self, node: cst.Call, scope: Scope) -> set[Gamepad | None]:
        """Return the gamepads that a call is one of, or that it gets as its first argument; None for other devices."""
        asked = [node.func.value] if isinstance(node.func, cst.Attribute) else []
        asked += [arg.value for arg in node.args[:1]]
        types = [each for part in asked for each in self._file.inference.infer(part, scope)]
        return {gamepad_of(self._file.table, [each.path]) for each in types if isinstance(each, Obj)}

    def _direction(self, node: cst.Call, position: int) -> None:
        if len(node.args) <= position or not node.args:
            return
        arg = node.args[position]
        direction = self.direction(arg.value)
        if direction is None:
            self._file.say(node, "The angle of a POV is a wpilib.POVDirection now.", "Write one of its names.")
            return
        spelled = self._file.imports.spell(f"wpilib.POVDirection.{direction}", None, self._file.module.scope)
        self._file.edit(arg, changed(value=cst.parse_expression(spelled)))

    def direction(self, node: cst.BaseExpression) -> str | None:
        """Return the name of a direction in degrees."""
        code = cst.Module([]).code_for_node(node).replace(" ", "")
        found = self._corrections["pov_directions"].get(code)
        return None if found is None else str(found)

    def _channel(self, node: cst.Call, scope: Scope, position: int) -> None:
        """Pass the channel of a DigitalInput in its place."""
        if len(node.args) <= position:
            return
        arg = node.args[position]
        types = {each.path for each in self._file.inference.infer(arg.value, scope) if isinstance(each, Obj)}
        if not types & {"wpilib.DigitalInput", "wpilib.DigitalSource"}:
            return
        made = arg.value
        if (
            isinstance(made, cst.Call)
            and len(made.args) == 1
            and Ref("wpilib.DigitalInput") in self._file.inference.infer(made.func, scope)
        ):
            self._file.consume(made.func, scope)
            self._file.edit(arg, lambda updated: updated.with_changes(value=updated.value.args[0].value, keyword=None))
        else:
            self._file.say(node, "This takes the number of a channel now, not a DigitalInput.", "Pass the number.")

    def _chooser(self, arg: cst.Arg, prefix: str) -> None:
        """Pass the name of a chooser instead of its path."""
        text = arg.value
        path = text.evaluated_value if isinstance(text, cst.SimpleString) else None
        if isinstance(text, cst.SimpleString) and isinstance(path, str) and path.startswith(prefix):
            name = path.removeprefix(prefix).rstrip("/")
            self._file.edit(arg, changed(value=cst.SimpleString(f"{text.quote}{name}{text.quote}")))
        else:
            self._file.say(arg, "This takes the name of a Selectable now.", f"Write it without {prefix}.")

    def _hid(self, node: cst.Call, scope: Scope, position: int) -> None:
        """Pass the GenericHID of a controller, which is none itself any more."""
        if len(node.args) <= position:
            return
        arg = node.args[position]
        types = {each.path for each in self._file.inference.infer(arg.value, scope) if isinstance(each, Obj)}
        if (
            types
            and _GENERIC_HID not in types
            and all(_GENERIC_HID in self._file.table.ancestors(each) for each in types)
        ):
            self._file.edit(
                arg, lambda updated: updated.with_changes(value=fill("{self}.get_hid()", {"self": updated.value}))
            )

    def _by_channel(self, node: cst.Call, scope: Scope, note: str) -> None:
        channel = written_number(self._file.inference, node.args[0].value, scope)
        if channel is not None:
            self._file.say(node, f"Channel {channel} must be in use here.", note, done=True)

    def _note_ports(self, node: cst.Call, scope: Scope, path: str) -> None:
        for arg in node.args[: 2 if path == _ENCODER else 1]:
            number = written_number(self._file.inference, arg.value, scope)
            if number is not None:
                self._ports.use(self._file.name_in_report, self._file.line(node), path, number)

    def _limit(self, node: cst.Call, scope: Scope, count: int) -> None:
        channel = written_number(self._file.inference, node.args[0].value, scope) if node.args else None
        if channel is not None and channel >= count:
            self._file.say(
                node,
                f"Channel {channel} does not exist on SystemCore.",
                f"It has the channels 0 to {count - 1}: write the one that you wire it to.",
            )
