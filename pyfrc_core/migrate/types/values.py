"""The expressions that are assigned to a name: for constants, whose value matters and not only their type."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

import libcst as cst

from ...season.names.table import Table
from .atoms import Atoms, OwnModuleRef, OwnObj, OwnRef
from .scopes import Binding, Module, OwnClass, OwnFunction, Scope


class Types(Protocol):
    """What is asked of `inference.Inference`."""

    table: Table

    @property
    def modules(self) -> Mapping[str, Module]: ...
    def annotated(self, node: cst.CSTNode, scope: Scope) -> Atoms: ...
    def returned(self, function: OwnFunction) -> Atoms: ...
    def with_stand_ins(self, annotated: Atoms, given: Callable[[], Atoms]) -> Atoms: ...
    def infer(self, node: cst.CSTNode, scope: Scope) -> Atoms: ...
    def lineage(self, own: OwnClass) -> tuple[list[OwnClass], list[str]]: ...
    def own_bindings(self, own: OwnClass, name: str) -> list[Binding]: ...


def values(inference: Types, node: cst.BaseExpression, scope: Scope) -> list[cst.CSTNode]:
    """Return the expressions that are assigned to a name, or to an attribute of the team's classes and modules."""
    bindings: list[Binding] = []
    if isinstance(node, cst.Name):
        bindings = [*scope.find(node.value)] or _from_stars(inference, node.value, scope)
    elif isinstance(node, cst.Attribute):
        for owner in inference.infer(node.value, scope):
            if isinstance(owner, OwnRef | OwnObj):
                lineage = inference.lineage(owner.own)[0]
                bindings += [each for own in lineage for each in inference.own_bindings(own, node.attr.value)]
            elif isinstance(owner, OwnModuleRef) and owner.module is not None:
                bindings += owner.module.scope.bindings.get(node.attr.value, ())
    imported = [other for each in bindings if each.kind == "from" for other in _at(inference.modules, each.path)]
    return [each.node for each in (*bindings, *imported) if each.kind == "value" and not each.unpacked]


def written_number(inference: Types, node: cst.BaseExpression, scope: Scope) -> int | None:
    """Return a whole number that is written here, or given to a name once."""
    found = [node] if isinstance(node, cst.Integer) else values(inference, node, scope)
    if len(found) == 1 and isinstance(found[0], cst.Integer):
        return int(found[0].evaluated_value)
    return None


def _from_stars(inference: Types, name: str, scope: Scope) -> list[Binding]:
    stars = scope.module.scope.bindings.get("*", ())
    return [each for star in stars for each in _at(inference.modules, f"{star.path}.{name}")]


def _at(modules: Mapping[str, Module], path: str) -> list[Binding]:
    """Return what binds a name of one of the project's modules."""
    module, _, name = path.rpartition(".")
    return [*modules[module].scope.bindings.get(name, ())] if module in modules else []
