"""Report what the types do not reach: names in strings, objects of unknown types, vendors' packages."""

from __future__ import annotations

import libcst as cst

from ..types.atoms import Obj, Ref
from ..types.scopes import Scope, dotted
from .edits import changed
from .file import FileRewriter

#: Functions that take the name of an attribute, and the position of that.
_BY_NAME = {"getattr": 1, "hasattr": 1, "setattr": 1, "delattr": 1, "object": 1, "attrgetter": 0, "methodcaller": 0}


class Leftovers:
    """What a file has that must be looked at by a person."""

    def __init__(self, file: FileRewriter) -> None:
        self._file = file
        self._camel = file.table.camel_names()

    def call(self, node: cst.Call, scope: Scope) -> None:
        """Rename the member that `getattr` and the like name in a string."""
        called = dotted(node.func).rpartition(".")[2]
        position = _BY_NAME.get(called, -1)
        if not 0 <= position < len(node.args) or (called == "object" and "patch" not in dotted(node.func)):
            return
        text = node.args[position].value
        owners = self._file.inference.infer(node.args[0].value, scope) if position else frozenset()
        name = text.evaluated_value if isinstance(text, cst.SimpleString) else None
        if isinstance(text, cst.SimpleString) and isinstance(name, str):
            found = self._file.lookup.found_in(owners, name)
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
        own = self._file.inference.is_own(value.partition(".")[0]) and last in self._camel
        if own or (known is not None and known.new != value) or (member is not None and member[1].new != last):
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
