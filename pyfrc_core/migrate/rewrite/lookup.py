"""What an attribute is, of all that it can be: WPILib's, the team's own, or the team's stand-in for one of WPILib's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import libcst as cst

from ...season.names.table import Member, Table
from ..types.atoms import Atoms, Obj, OwnObj, OwnRef, Ref
from ..types.inference import Inference
from ..types.scopes import Module, OwnClass, Scope


@dataclass(frozen=True)
class Found:
    """What an attribute is, of all that it can be.

    :param owner: the class that defines the member, or "" for a name of a module
    :param receiver: the class that it was asked for
    :param member: None if WPILib has no such name
    :param stays: the name is the team's own, or has not changed
    """

    owner: str
    receiver: str
    path: str
    member: Member | None
    stays: bool = False


class Lookup:
    """The lookup of attributes in a project."""

    def __init__(self, table: Table, inference: Inference, modules: Iterable[Module]) -> None:
        self.table = table
        self.inference = inference
        #: The new names of methods of the team's that stand in for WPILib's, such as those of a fake sensor, with
        #: what they stand in for.
        self.stand_ins: dict[tuple[OwnClass, str], tuple[str, str]] = {}
        sites = [
            (node, scope)
            for module in modules
            for node, scope in module.sites
            if isinstance(node, cst.Attribute) and len(inference.infer(node.value, scope)) > 1
        ]
        while any(self._link(node, scope) for node, scope in sites):
            pass  # what is linked can link others

    def attribute(self, node: cst.Attribute, scope: Scope) -> list[Found]:
        """Return what an attribute can be, where it is WPILib's or overrides what is WPILib's."""
        return self.found_in(self.inference.infer(node.value, scope), node.attr.value)

    def found_in(self, owners: Atoms, name: str) -> list[Found]:
        """Return what a member of any of these can be."""
        found: list[Found] = []
        for owner in owners:
            if isinstance(owner, Ref):
                path = self.table.canonical(f"{owner.path}.{name}")
                known = self.table.name(path)
                if path in self.table.modules or known is not None:
                    found.append(Found("", "", path, known))
                    continue
            if isinstance(owner, Ref | Obj):
                found += self.member_of([owner.path], name)
            elif isinstance(owner, OwnObj | OwnRef):
                mine, theirs = self.inference.family(owner.own)
                members = self.member_of(theirs, name)
                own = [each for each in mine if self.inference.own_bindings(each, name)]
                stand_in = next((new for each in own if (new := self.stand_ins.get((each, name)))), None)
                if stand_in is not None:
                    found.append(Found(owner.own.name, "", stand_in[1], Member(name, stand_in[0])))
                elif (own and not any(_methods(each, name) for each in own)) or (own and not members):
                    found.append(Found("-", "", "", Member(name, name), stays=True))
                else:
                    found += members
        return found

    def member_of(self, classes: list[str], name: str) -> list[Found]:
        """Return a member of the first of the classes that has it; a class inside a class too."""
        for path in classes:
            for each in self.table.ancestors(path):
                nested = self.table.name(f"{each}.{name}")
                if nested is not None:
                    return [Found("", path, f"{each}.{name}", nested)]
            member = self.table.member(path, name)
            if member is not None:
                return [Found(member[0], path, f"{member[0]}.{name}", member[1])]
        return []

    def new_name(self, found: Found) -> str | None:
        """Return what becomes of it; None if it is gone."""
        if found.owner:
            return None if found.member is None else found.member.new
        return self.table.new_path(found.path)

    def _link(self, node: cst.Attribute, scope: Scope) -> bool:
        """Let the team's methods have WPILib's new name where an object can be either. Return whether that is new."""
        owners, name = self.inference.infer(node.value, scope), node.attr.value
        found = self.found_in(owners, name)
        new = {self.new_name(each): each.path for each in found if not each.stays}
        if len(new) != 1 or not any(each.stays for each in found):
            return False
        ((name_now, path),) = new.items()
        if name_now is None or not name_now.isidentifier() or name_now == name:
            return False
        linked = {
            (each, name)
            for owner in owners
            if isinstance(owner, OwnObj | OwnRef)
            for each in self.inference.family(owner.own)[0]
            if _methods(each, name) and not self.inference.own_bindings(each, name_now)
        }
        is_new = not self.stand_ins.keys() >= linked
        self.stand_ins |= {each: (name_now, path) for each in linked if each not in self.stand_ins}
        return is_new

    def name_from(self, path: str, seen: frozenset[str] = frozenset()) -> str | None:
        """Return the name that a `from` import of a path has to say now; None if a circle defines it nowhere.

        A module of the project's that has the name from an import of its own has it under the new name, too.
        """
        module, _, name = path.rpartition(".")
        if path in seen:
            return None
        if module not in self.inference.modules:
            new = self.table.new_path(self.table.canonical(path)) if self.table.name(path) is not None else None
            return name if new is None else new.rpartition(".")[2]
        scope = self.inference.modules[module].scope
        bindings = scope.bindings.get(name, [])
        found = [
            self.name_from(each.path, seen | {path}) if each.kind == "from" and each.path.endswith(f".{name}") else name
            for each in bindings
        ]
        return next((each for each in found if each is not None), None if found else name)

    def renamed_methods(self, module: Module) -> Iterator[tuple[cst.FunctionDef, str, str]]:
        """Return the methods of a module that stand in for WPILib's: each with its new name, and of what."""
        for (own, name), (new, path) in self.stand_ins.items():
            if own.scope.module is module:
                yield from ((method, new, path) for method in _methods(own, name))


def _methods(own: OwnClass, name: str) -> list[cst.FunctionDef]:
    bindings = own.scope.bindings.get(name, ())
    return [each.node for each in bindings if isinstance(each.node, cst.FunctionDef)]
