"""Report what the types do not reach: names in strings, objects of unknown types, vendors' packages."""

from __future__ import annotations

import libcst as cst

from ...season.spelling import snake_case
from ..types.atoms import Obj, Ref
from ..types.scopes import Scope, dotted
from .edits import changed
from .file import FileRewriter

_BY_NAME = {"getattr", "hasattr", "setattr", "delattr"}


class Leftovers:
    """What a file has that must be looked at by a person.

    :param own_names: every name that the project itself defines
    """

    def __init__(self, file: FileRewriter, own_names: frozenset[str], camel_names: frozenset[str]) -> None:
        self._file = file
        self._camel = camel_names - own_names

    def attribute(self, node: cst.Attribute, scope: Scope) -> None:
        """Report an attribute with the name of one of WPILib's, of an object whose type is not known."""
        name = node.attr.value
        if name not in self._camel or node in self._file.handled or node in self._file.edits:
            return
        if not self._file.inference.infer(node.value, scope):
            self._file.say(
                node,
                f"What {_text(node.value)} is could not be found out, so {name} stays.",
                f"If it is WPILib's, write {snake_case(name)}.",
            )

    def call(self, node: cst.Call, scope: Scope) -> None:
        """Rename the member that `getattr` and the like name in a string."""
        if not isinstance(node.func, cst.Name | cst.Attribute) or len(node.args) < 2:
            return
        called = dotted(node.func).rpartition(".")[2]
        if called not in _BY_NAME:
            return
        text = node.args[1].value
        owners = self._file.inference.infer(node.args[0].value, scope)
        name = text.evaluated_value if isinstance(text, cst.SimpleString) else None
        if isinstance(text, cst.SimpleString) and isinstance(name, str):
            found = self._file.found_in(owners, name)
            new = {each.member.new for each in found if each.member is not None}
            if len(new) == 1 and (changed_name := new.pop()) and changed_name.isidentifier():
                self._file.edit(text, changed(value=f"{text.prefix}{text.quote}{changed_name}{text.quote}"))
            elif name in self._camel:
                self._file.say(node, f"{called} names {name}.", "Write the new name if it is WPILib's.")
        elif any(isinstance(each, Obj | Ref) for each in owners):
            self._file.say(node, f"{called} takes a name that is made while the robot runs.", "Check its names.")

    def text(self, node: cst.SimpleString) -> None:
        """Report a path of WPILib's in a string, as `mock.patch` takes it."""
        value = node.evaluated_value
        if not isinstance(value, str) or "." not in value or not value.replace(".", "").isidentifier():
            return
        known = self._file.table.name(value)
        outer, _, last = value.rpartition(".")
        member = self._file.table.member(outer, last) if self._file.table.name(outer) else None
        if (known is not None and known.new != value) or (member is not None and member[1].new != last):
            self._file.say(node, f"The text {value!r} names something of WPILib 2026.", "Write its new path.")

    def imports(self, node: cst.Import | cst.ImportFrom) -> None:
        """Report the packages of vendors, and modules that are gone."""
        if isinstance(node, cst.Import):
            paths = [dotted(alias.name) for alias in node.names]
        else:
            paths = [] if node.relative or node.module is None else [dotted(node.module)]
        for path in paths:
            vendor = self._file.table.corrections["vendors"].get(path.partition(".")[0])
            if vendor is not None:
                self._file.say(node, f"{path.partition('.')[0]} is a vendor's package.", vendor)
            elif path in self._file.table.modules and not self._file.table.modules[path]:
                self._file.say(node, f"{path} is gone.", self._file.table.advice(path))


def _text(node: cst.BaseExpression) -> str:
    text = " ".join(cst.Module([]).code_for_node(node).split())
    return text if len(text) <= 40 else text[:37] + "..."
