"""Report objects whose type is not known and that are used as WPILib's are: once for each missing type hint."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import libcst as cst

from ...season.spelling import snake_case
from ..report import Report
from ..types.atoms import OwnObj, OwnRef
from ..types.causes import Cause, Causes
from ..types.scopes import Module, OwnClass, Scope, dotted
from .file import FileRewriter
from .lookup import Lookup

#: The classes whose methods WPILib calls.
_CALLED = (
    *("wpilib.TimedRobot", "commands2.Command", "commands2.Subsystem", "magicbot.MagicRobot", "wpiutil.Sendable"),
    "robotpy_ext.autonomous.StatefulAutonomous",
)
#: Names that are spelled alike in both seasons, but stand for another one of a motor's: with how many arguments.
_MOTOR = {"set": (1, "set_throttle"), "get": (0, "get_throttle")}
_SHOWN = 5
#: So many types that an object can be, according to the names that are used of it, are worth to name.
_TYPES = 3


@dataclass
class _Uses:
    """:param own: the names that are asked of the object itself, not of a part of it"""

    cause: Cause
    places: set[tuple[str, int, str]] = field(default_factory=set)
    own: set[str] = field(default_factory=set)


class Unknown:
    """The objects of unknown type in a project."""

    def __init__(self, lookup: Lookup, modules: Mapping[str, Module]) -> None:
        self._lookup = lookup
        self._table = lookup.table
        self._modules = modules
        self._causes = Causes(lookup.inference)
        self._camel = self._table.camel_names()
        self._called_by_wpilib = {name for path in _CALLED for name in self._table.member_names(path)} & self._camel
        self._uses: dict[object, _Uses] = {}

    def attribute(self, file: FileRewriter, node: cst.Attribute, scope: Scope) -> None:
        """Note an attribute with a name of WPILib's, of an object whose type is not known."""
        if node.attr.value in self._camel:
            self._attribute(file, node, scope)

    def call(self, file: FileRewriter, node: cst.Call, scope: Scope) -> None:
        """Note a call that is like one of a motor's."""
        func = node.func
        known = _MOTOR.get(func.attr.value) if isinstance(func, cst.Attribute) else None
        if isinstance(func, cst.Attribute) and known is not None and len(node.args) == known[0]:
            self._attribute(file, func, scope)

    def _attribute(self, file: FileRewriter, node: cst.Attribute, scope: Scope) -> None:
        if node in file.handled or node in file.edits:
            return
        name, owners = node.attr.value, self._lookup.inference.infer(node.value, scope)
        cause: Cause | None = None
        if not owners:
            cause = self._causes.of(node.value, scope)
        elif not self._lookup.found_in(owners, name):
            for owner in owners:
                if isinstance(owner, OwnObj | OwnRef) and cause is None:
                    cause = self._causes.of_base(owner.own) or self._missing(owner.own, name)
        if cause is not None:
            self._note(cause, file, node, name)

    def _missing(self, own: OwnClass, name: str) -> Cause | None:
        """Return the cause of an attribute that no class of the project, nor WPILib, gives a class without bases."""
        return None if own.node.bases else Cause("attribute", name, own.scope.module, own.node, own.name)

    def methods(self, file: FileRewriter, own: OwnClass) -> None:
        """Note the methods that WPILib would call if the class were derived from one of its own."""
        names = [name for name in own.scope.bindings if name in self._called_by_wpilib]
        cause = self._causes.of_base(own) if names and not self._lookup.inference.family(own)[1] else None
        for name in names if cause is not None else ():
            for each in own.scope.bindings[name]:
                if cause is not None and isinstance(each.node, cst.FunctionDef):
                    self._note(cause, file, each.node, name)

    def _note(self, cause: Cause, file: FileRewriter, node: cst.CSTNode, name: str) -> None:
        if cause.kind == "package" and cause.name in self._table.corrections["vendors"]:
            return  # said at the import
        key = (cause.kind, cause.name, cause.imported if cause.kind == "package" else cause.node)
        uses = self._uses.setdefault(key, _Uses(cause))
        uses.places.add((file.name_in_report, file.line(node), name))
        of_a_part = cause.kind in ("parameter", "attribute", "variable") and isinstance(node, cst.Attribute)
        if not of_a_part or (isinstance(node, cst.Attribute) and dotted(node.value).rpartition(".")[2] == cause.name):
            uses.own.add(name)

    def report(self, report: Report, files: Mapping[Module, FileRewriter]) -> None:
        """Report each cause with all its places."""
        for uses in self._uses.values():
            cause, names = uses.cause, sorted({name for _, _, name in uses.places})
            used = {*self._names_used(cause)}
            types = self._types(cause, {*names, *used})
            if types is None:
                continue
            its_own = types if uses.own == {*names} else self._types(cause, uses.own | used) or []
            home = files[cause.module]
            where = f"{home.name_in_report}:{home.line(cause.node)}"
            more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
            new = [self._new(each, types) for each in names[:_SHOWN] if each not in _MOTOR]
            new += [f"{_MOTOR[each][1]} if it is a motor" for each in names[:_SHOWN] if each in _MOTOR]
            what = f"{_subject(cause, where)} not known, so these names stay: {', '.join(names[:_SHOWN])}{more}."
            could_be = [self._table.new_path(each) or each for each in its_own[: _TYPES + 1]]
            first, *others = could_be if 0 < len(could_be) <= _TYPES else [""]
            hint = _hint(cause, first) + (f"It could also be {' or '.join(others)}. " if others else "")
            remedy = f"{hint}Migrate again; or write {', '.join(new)}{more}."
            if cause.kind == "missing" and first:
                also = f" It could also be of {' or '.join(others)}." if others else ""
                remedy = f"Write {', '.join(f'{first}.{each}' for each in new)}{more}.{also}"
            for file, line, _ in uses.places:
                report.add(file, line, what, remedy)

    def _new(self, name: str, types: list[str]) -> str:
        found = self._lookup.member_of(types[:1], name)
        new = self._lookup.new_name(found[0]) if found else snake_case(name)
        return "__init__" if name == "robotInit" else new or f"({name} is gone)"

    def _names_used(self, cause: Cause) -> Iterator[str]:
        """Return the names of all attributes that the project asks of what has the cause's name."""
        if cause.kind in ("package", "python", "missing", "result"):
            return
        for node, scope in (site for module in self._modules.values() for site in module.sites):
            named = isinstance(node, cst.Attribute) and dotted(node.value).rpartition(".")[2] == cause.name
            if named and isinstance(node, cst.Attribute) and not self._lookup.inference.infer(node.value, scope):
                yield node.attr.value

    def _types(self, cause: Cause, names: set[str]) -> list[str] | None:
        """Return the types that have all of the names; None if only classes of the team's do, whose names stay."""
        theirs = self._table.classes_with(names)
        own = [
            each
            for module in self._modules.values()
            for each in module.classes
            if all(self._has(each, name) for name in names)
        ]
        stay = [each for each in own if all(self._stays(each, name) for name in names)]
        if own and len(stay) == len(own) and not theirs and cause.kind != "package":
            return None
        return theirs if cause.kind == "package" else [*(each.name for each in own), *theirs]

    def _has(self, own: OwnClass, name: str) -> bool:
        mine, theirs = self._lookup.inference.lineage(own)
        return any(self._lookup.inference.own_bindings(each, name) for each in mine) or bool(
            self._lookup.member_of(theirs, name)
        )

    def _stays(self, own: OwnClass, name: str) -> bool:
        return all(each.stays for each in self._lookup.found_in(frozenset({OwnObj(own)}), name))


def _subject(cause: Cause, where: str) -> str:
    if cause.kind == "package":
        return f"{f'{cause.imported} of ' if cause.imported else ''}{cause.name} is outside this project and"
    if cause.kind == "parameter":
        return f"What {cause.name} is, a parameter of {cause.inside} ({where}), is"
    if cause.kind == "result":
        return f"What {cause.name} returns ({where}) is"
    if cause.kind in ("python", "missing"):
        return f"What {cause.imported or cause.name} gives here is"
    return f"What {f'{cause.inside}.' if cause.inside else ''}{cause.name} is ({where}) is"


def _hint(cause: Cause, type_: str) -> str:
    """Return how to say a type, as code."""
    name, named = cause.name, type_ or "its class"
    if cause.kind == "package" and cause.imported:
        module, _, last = type_.rpartition(".")
        source = f"from {module} import {last} as {cause.imported}" if module else f"from ... import {cause.imported}"
        return (
            f"Migrate {name}, too. If this is WPILib's, write so at its import:\n"
            f"if TYPE_CHECKING: {source}\nelse: from {name} import {cause.imported}\n"
        )
    if cause.kind == "package":
        return f"Migrate {name}, too. If an object of it is WPILib's, write its type where you take it (it: {named}). "
    if cause.kind in ("python", "missing"):
        return f"Give it a name with a type first: it: {named} = ... "
    if cause.kind == "result":
        return f"Write what it returns there: def {name}(...) -> {named}: ... "
    if cause.kind == "parameter" and cause.inside.endswith("a lambda"):
        return f"Write a function with a type in place of the lambda: def go({name}: {named}): ... "
    if cause.kind == "parameter":
        return f"Write its type there: {name}: {named}. "
    return f"Write its type {f'into class {cause.inside}' if cause.inside else 'before it is used'}: {name}: {named}. "
