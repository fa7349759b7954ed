"""Rewrite calls whose meaning changed, as `corrections.toml` says; and the keywords of all calls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import libcst as cst

from ...season.spelling import snake_case
from ..types.atoms import Atom, Bound, Obj, OwnObj, Ref
from ..types.scopes import Scope
from .arguments import Arguments
from .edits import changed, fill, renamed, replaced
from .file import FileRewriter
from .gamepads import Sticks
from .lookup import Found
from .repeated_logs import RepeatedLogs
from .robot_init import super_call

_BOTH = "wpilib.interfaces.GenericHID.RumbleType.kBothRumble"
_ADD_TO_TAB = "wpilib.shuffleboard.ShuffleboardContainer.add"
_TABLE = '<ntcore.NetworkTableInstance>.get_default().get_table("SmartDashboard")'


class Calls:
    """The calls of a file.

    :param dashboard_reads: the keys that the project reads from SmartDashboard
    :param arguments: of the calls
    """

    def __init__(self, rewriter: FileRewriter, dashboard_reads: frozenset[str], arguments: Arguments) -> None:
        self._file = rewriter
        self._reads = dashboard_reads
        self._arguments = arguments
        self._sticks = Sticks(rewriter)
        self._repeated = RepeatedLogs(rewriter)
        self._corrections: Mapping[str, Any] = rewriter.table.corrections

    def call(self, node: cst.Call, scope: Scope) -> None:
        """Rewrite a call."""
        base = self._base(node, scope)
        if base is not None:
            self._arguments.keywords(node, base)
            if self._file.first_time:
                self._arguments.changed_meaning(node, scope, [base.path])
            return
        found = self._called(node, scope)
        if found is None:
            return
        if self._left_for_both(node, scope):
            self._file.edit(node, _both_calls)
        paths = self._paths(found)
        self._arguments.keywords(node, found)
        if found.member is not None and found.member.is_value and not node.args:
            self._file.edit(node, _without_call)
        if self._dashboard(node, scope, found):
            return
        template = next(
            (each for path in paths if (each := self._corrections["templates"].get(path)) is not None), None
        )
        is_alias = isinstance(node.func, cst.Name) and found.owner  # rewritten where it is given its name
        if template is not None and not is_alias and self._template(node, scope, template):
            for note in (each for path in paths if (each := self._corrections["notes"].get(path))):
                self._file.say(node, f"{found.path} is rewritten.", note, done=True)
            return
        if not self._file.first_time:
            return
        if isinstance(node.func, cst.Name) and (note := self._corrections["notes"].get(found.path)):
            self._file.say(node, f"{node.func.value} has another meaning.", note, done=True)
        self._sticks.call(node, scope, found.path)
        self._arguments.changed_meaning(node, scope, paths)

    def _base(self, node: cst.Call, scope: Scope) -> Found | None:
        """Return the class whose constructor `super().__init__(...)` is."""
        if not isinstance(node.func, cst.Attribute) or node.func.attr.value != "__init__":
            return None
        for each in self._file.inference.infer(node.func.value, scope):
            if isinstance(each, OwnObj) and each.above:
                own = [*self._file.inference.lineage(each.own)[0][1:]]
                theirs = [] if own else self._file.inference.lineage(each.own)[1]
                for path in theirs:
                    if (name := self._file.table.name(path)) is not None:
                        return Found("", "", path, name)
        return None

    def _called(self, node: cst.Call, scope: Scope) -> Found | None:
        if isinstance(node.func, cst.Attribute):
            found = self._file.lookup.attribute(node.func, scope)
            if found and not any(each.stays for each in found):
                return found[0] if found[0].member is not None else None
        for each in self._file.inference.infer(node.func, scope):
            if isinstance(each, Ref) and (name := self._file.table.name(each.path)) is not None:
                return Found("", "", each.path, name)
            if isinstance(each, Bound) and (member := self._file.table.member(each.owner, each.name)) is not None:
                return Found(each.owner, each.owner, f"{each.owner}.{each.name}", member[1])
        return None

    def _paths(self, found: Found) -> list[str]:
        """Return the paths by which corrections may know what is called."""
        if not found.owner:
            return [found.path]
        name = found.path.rpartition(".")[2]
        return [f"{each}.{name}" for each in self._file.table.ancestors(found.receiver)]

    # Templates

    def _template(self, node: cst.Call, scope: Scope, template: Any) -> bool:
        if isinstance(template, Mapping):
            template = template.get(str(len(node.args)))
        plain = not any(arg.star or arg.keyword for arg in node.args)
        if template is None or not (plain or "{0}" not in template):
            return False
        if template.endswith(".u(0)") and node in self._file.module.subscripted:
            return False  # the number is taken from the array already
        for position, arg in enumerate(node.args):
            if "{args}" not in template and f"{{{position}}}" not in template:
                self._file.consume_all(arg.value, scope)
        self.replace(node, scope, template)
        return True

    def replace(self, node: cst.Call, scope: Scope, template: str) -> None:
        """Replace a call by a template."""
        root = self._file.consume(node.func, scope)
        text = self._file.imports.fill_in(template, root, scope)

        def edit(updated: cst.Call) -> cst.BaseExpression:
            parts = {str(index): arg.value for index, arg in enumerate(updated.args)}
            if isinstance(updated.func, cst.Attribute):
                parts["self"] = updated.func.value
            new = fill(text, parts, updated)
            return new.with_changes(lpar=[*updated.lpar, *new.lpar], rpar=[*new.rpar, *updated.rpar])

        self._file.edit(node, edit)

    def _dashboard(self, node: cst.Call, scope: Scope, found: Found) -> bool:
        if found.owner != "wpilib.SmartDashboard":
            return False
        name = found.path.rpartition(".")[2]
        if name == "putData":
            return self._put_data(node, scope)
        key = key_of(node)
        read = key is None or key in self._reads
        member = snake_case(name)
        if name not in self._corrections["dashboard_table"]["members"] or (name.startswith("put") and not read):
            return False
        self.replace(node, scope, f"{_TABLE}.{member}({{args}})")
        if not name.startswith("put"):
            self._file.say(
                node,
                f"SmartDashboard.{name} reads NetworkTables' SmartDashboard table now.",
                "A setting that a dashboard changes is better a tunable: tunables.add(name, value).",
                done=True,
            )
        return True

    def _put_data(self, node: cst.Call, scope: Scope) -> bool:
        if not 1 <= len(node.args) <= 2 or any(arg.keyword or arg.star for arg in node.args):
            return False
        types = self._file.inference.infer(node.args[-1].value, scope)
        bases = {name: each for of in types for name, each in self._sendable(of)}
        if len(bases) != 1:
            return False
        ((name, ancestors),) = bases.items()
        arguments = "{args}" if len(node.args) == 2 else f'"{name}", {{0}}'
        if ancestors.intersection(self._corrections["tunables"]["classes"]):
            self.replace(node, scope, f"<tunables.publish>({arguments})")
            return True
        code = [cst.Module([]).code_for_node(arg.value) for arg in node.args]
        code = code if len(code) == 2 else [f'"{name}"', *code]
        if self._repeated.move(node, scope, ", ".join(code)):
            what = "SmartDashboard.putData is telemetry.log now, and called again and again."
            self._file.say(node, what, done=True)
            return True
        self.replace(node, scope, f"<telemetry.log>({arguments})")
        self._file.say(
            node,
            "SmartDashboard.putData is telemetry.log now, which logs the values of this moment.",
            "Call it in robot_periodic to log them again and again.",
            done=True,
        )
        return True

    def _sendable(self, of: Atom) -> Iterator[tuple[str, set[str]]]:
        """Return the name that the dashboard shows of something that was a Sendable, and its class with all bases."""
        if isinstance(of, OwnObj):
            bases = self._file.inference.lineage(of.own)[1]
            name = of.own.name
        elif isinstance(of, Obj):
            bases, name = [of.path], of.path.rpartition(".")[2]
        else:
            return
        every = {each for base in bases for each in self._file.table.ancestors(base)}
        if every & {"wpiutil.Sendable", "ntcore.NTSendable", "wpilib.SendableChooser"}:
            yield {"CommandScheduler": "Scheduler", "Field2d": "Field"}.get(name, name), every

    # Comparisons and statements

    def comparison(self, node: cst.Comparison, scope: Scope) -> None:
        """Rewrite a POV that is compared with an angle."""
        if not self._file.first_time or not self.is_pov(node.left, scope):
            return
        for target in node.comparisons:
            values = [target.comparator]
            if isinstance(target.comparator, cst.Tuple | cst.List | cst.Set):
                values = [each.value for each in target.comparator.elements]
            directions = [self._arguments.direction(each) for each in values]
            if None in directions or not isinstance(target.operator, cst.Equal | cst.NotEqual | cst.In | cst.NotIn):
                return
            for value, direction in zip(values, directions, strict=True):
                spelled = self._file.imports.spell(f"wpilib.POVDirection.{direction}", None, scope)
                self._file.edit(value, replaced(cst.parse_expression(spelled)))
        self._file.handled.add(node.left)
        if isinstance(node.left, cst.Call) and isinstance(node.left.func, cst.Attribute):
            self._file.attribute(node.left.func, scope)
            self._file.handled.add(node.left.func)

    def is_pov(self, node: cst.BaseExpression, scope: Scope) -> bool:
        """Return whether an expression asks for a POV's angle."""
        found = self._called(node, scope) if isinstance(node, cst.Call) else None
        return found is not None and any(path in self._corrections["povs"] for path in self._paths(found))

    def other_pov(self, node: cst.Call, scope: Scope) -> None:
        """Report a POV whose angle is used in another way."""
        if self._file.first_time and node not in self._file.handled and self.is_pov(node, scope):
            self._file.say(
                node,
                "A POV is a wpilib.POVDirection now, not an angle.",
                "Compare it with wpilib.POVDirection.UP and the like, or use wpilib.get_pov_angle.",
            )

    def statement(self, node: cst.Expr, scope: Scope) -> None:
        """Remove a statement that is not needed any more, or keep the object that a call returns now."""
        if not isinstance(node.value, cst.Call):
            return
        found = self._called(node.value, scope)
        if found is None or super_call(self._file, node.value, scope):
            return
        paths = self._paths(found)
        if any(path in self._corrections["not_needed"]["calls"] for path in paths):
            self._remove(node, scope)
            advice = self._file.table.advice(found.path) if found.path in self._corrections["gone"] else ""
            self._file.say(node, f"{found.path} is gone, and removed here.", advice, done=True)
        gyros = self._corrections["not_needed"]["gyros"]
        if found.path in gyros and (key_of(node.value) or "").startswith(gyros[found.path]):
            self._remove(node, scope)
            self._file.say(node, "OnboardIMU turns with the robot by itself: removed here.", done=True)
        if found.path == _ADD_TO_TAB and len(node.value.args) == 2:
            self._add_to_tab(node.value)
        func = node.value.func
        if self._left_for_both(node.value, scope):
            self._file.edit(node, _for_both)
        if (
            self._file.first_time
            and any(path in self._corrections["returns_new"]["methods"] for path in paths)
            and isinstance(func, cst.Attribute)
            and isinstance(func.value, cst.Name | cst.Attribute)
        ):

            def assigned(updated: cst.Expr) -> cst.Assign:
                target = cst.ensure_type(cst.ensure_type(updated.value, cst.Call).func, cst.Attribute).value
                assert isinstance(target, cst.Name | cst.Attribute)
                return cst.Assign([cst.AssignTarget(target)], updated.value)

            self._file.edit(node, assigned)

    def _remove(self, node: cst.Expr, scope: Scope) -> None:
        self._file.consume(cst.ensure_type(node.value, cst.Call).func, scope)
        self._file.remove(node)

    def _add_to_tab(self, node: cst.Call) -> None:
        self._file.handled.add(node.func)
        self._file.edit(node.func, renamed("log"))
        for arg in node.args:
            self._file.edit(arg, changed(keyword=None, equal=cst.MaybeSentinel.DEFAULT))
        self._file.say(
            node,
            "A Shuffleboard tab is a telemetry table now, which logs the values of this moment.",
            "Call it in robot_periodic to log them again and again.",
            done=True,
        )

    def _left_for_both(self, node: cst.Call, scope: Scope) -> bool:
        """Let a call set the rumble of the left side, if it sets both."""
        values = [each.value for each in node.args if isinstance(each.value, cst.Attribute)]
        for value in values:
            if value not in self._file.handled and self._is_both(value, scope):
                self._file.handled.add(value)
                self._file.edit(value, renamed("LEFT_RUMBLE"))
                return True
        return False

    def _is_both(self, node: cst.Attribute, scope: Scope) -> bool:
        return any(each.path == _BOTH for each in self._file.lookup.attribute(node, scope))


def _without_call(updated: cst.Call) -> cst.BaseExpression:
    func = updated.func
    return func.with_changes(lpar=[*updated.lpar, *func.lpar], rpar=[*func.rpar, *updated.rpar])


def _for_both(statement: cst.Expr) -> cst.FlattenSentinel[cst.BaseSmallStatement]:
    return cst.FlattenSentinel([statement, cst.Expr(_right(statement.value))])


def _both_calls(call: cst.Call) -> cst.Tuple:
    """Return two calls where one expression stands, as in a lambda."""
    return cst.Tuple([cst.Element(call), cst.Element(_right(call))])


def _right(call: cst.BaseExpression) -> cst.BaseExpression:
    return cst.parse_expression(cst.Module([]).code_for_node(call).replace("LEFT_RUMBLE", "RIGHT_RUMBLE"))


def key_of(node: cst.Call) -> str | None:
    """Return the first argument, if it is a plain text."""
    first = node.args[0].value if node.args else None
    return str(first.evaluated_value) if isinstance(first, cst.SimpleString) else None
