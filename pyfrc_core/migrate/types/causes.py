"""Why the type of an expression is not known: the one place where a type hint would say it.

One parameter without a type is often behind half of a report's lines. What comes from Python itself, such as a number
or an object of `threading`, has no cause: it is none of WPILib's.
"""

from __future__ import annotations

import builtins
import sys
from collections.abc import Iterable
from dataclasses import dataclass

import libcst as cst

from .atoms import Bound, Obj, OwnCallable, OwnModuleRef, OwnObj, OwnRef, Ref
from .inference import Inference
from .scopes import Binding, Module, OwnClass, OwnFunction, Scope

#: Modules and functions of Python that pass objects of others on.
_CARRY_MODULES = {
    *("asyncio", "collections", "concurrent", "contextlib", "copy", "dataclasses", "functools", "itertools"),
    *("multiprocessing", "operator", "queue", "types", "typing", "unittest", "weakref"),
}
_CARRY = {"filter", "getattr", "iter", "list", "map", "max", "min", "next", "reversed", "set", "sorted", "tuple", "zip"}
_ANYTHING = {"Any", "object", "type", "Callable", "TypeVar"}


@dataclass(frozen=True)
class Cause:
    """Where a type hint is missing.

    :param kind: `package`, `parameter`, `attribute`, `variable`, `result`, `python` for what a function of Python's
                 passes on, or `missing` for a name that the library of 2026 has not there
    :param name: of the parameter, attribute, variable or function; of the package
    :param node: where it is; of a package, the import
    :param inside: the function of a parameter, the class of an attribute; else ""
    :param imported: of a package, the name that is imported, "" for all
    """

    kind: str
    name: str
    module: Module
    node: cst.CSTNode
    inside: str = ""
    imported: str = ""


class Causes:
    """The causes in a project."""

    def __init__(self, inference: Inference) -> None:
        self._inference = inference

    def of(self, node: cst.CSTNode, scope: Scope) -> Cause | None:
        """Return why it is not known what an expression is; None if it is Python's own."""
        return self._expression(node, scope, set())

    def of_base(self, own: OwnClass) -> Cause | None:
        """Return the package with a class from which one of the team's is derived."""
        for each in self._inference.family(own)[0]:
            for base in each.node.bases:
                if not self._inference.infer(base.value, each.outer):
                    cause = self._expression(base.value, each.outer, set())
                    if cause is not None:
                        return cause
        return None

    def _expression(self, node: cst.CSTNode, scope: Scope, seen: set[object]) -> Cause | None:
        if (node, scope) in seen:
            return None
        seen.add((node, scope))
        if isinstance(node, cst.Name):
            bindings = scope.find(node.value)
            if not bindings and hasattr(builtins, node.value):
                return None
            stars = scope.module.scope.bindings.get("*", ())
            return self._bound(node.value, bindings or [*stars], seen, scope.module)
        if isinstance(node, cst.Attribute):
            return self._attribute(node, scope, seen)
        if isinstance(node, cst.Call):
            return self._call(node, scope, seen)
        parts: Iterable[cst.CSTNode] = ()
        if isinstance(node, cst.Subscript | cst.NamedExpr):
            parts = [node.value]
        elif isinstance(node, cst.Await):
            parts = [node.expression]
        elif isinstance(node, cst.IfExp):
            parts = [node.body, node.orelse]
        elif isinstance(node, cst.BooleanOperation | cst.BinaryOperation):
            parts = [node.left, node.right]
        elif isinstance(node, cst.List | cst.Tuple | cst.Set | cst.Dict):
            parts = [each.value for each in node.elements]
        elif isinstance(node, cst.ListComp | cst.SetComp | cst.GeneratorExp):
            parts, scope = [node.elt], scope.module.comprehensions.get(node.elt, scope)
        elif isinstance(node, cst.DictComp):
            parts, scope = [node.value], scope.module.comprehensions.get(node.value, scope)
        return self._first(parts, scope, seen)

    def _first(self, parts: Iterable[cst.CSTNode], scope: Scope, seen: set[object]) -> Cause | None:
        unknown = (each for each in parts if not self._inference.infer(each, scope))
        return next((found for each in unknown if (found := self._expression(each, scope, seen))), None)

    def _attribute(self, node: cst.Attribute, scope: Scope, seen: set[object]) -> Cause | None:
        name = node.attr.value
        owners = self._inference.infer(node.value, scope)
        if not owners:
            return self._expression(node.value, scope, seen)
        for owner in owners:
            if isinstance(owner, OwnModuleRef) and owner.module is not None:
                return self._bound(name, owner.module.scope.bindings.get(name, ()), seen, owner.module)
            if isinstance(owner, OwnObj | OwnRef):
                family = self._inference.family(owner.own)[0]
                bindings = [each for own in family for each in self._inference.own_bindings(own, name)]
                if bindings:
                    return self._bound(name, bindings, seen, owner.own.scope.module, owner.own)
                missing = Cause("attribute", name, owner.own.scope.module, owner.own.node, owner.own.name)
                return self.of_base(owner.own) or missing
            if isinstance(owner, Ref | Obj):  # WPILib 2026 has no such name
                return Cause("missing", name, scope.module, node)
        return None

    def _call(self, node: cst.Call, scope: Scope, seen: set[object]) -> Cause | None:
        called = self._inference.infer(node.func, scope)
        if isinstance(node.func, cst.Name) and not scope.find(node.func.value) and not called:
            return self._first([arg.value for arg in node.args], scope, seen) if node.func.value in _CARRY else None
        for each in called:
            if isinstance(each, OwnCallable):
                function = each.function
                returns = function.node.returns if isinstance(function.node, cst.FunctionDef) else None
                if returns is not None:
                    return self._hint(returns.annotation, function.outer, self._result(function))
                for value, inner in function.returned:
                    if not self._inference.infer(value, inner):
                        found = self._expression(value, inner, seen)
                        if found is not None:
                            return found
            if isinstance(each, Ref | Bound | OwnCallable):
                return None
        return self._expression(node.func, scope, seen)

    def _result(self, function: OwnFunction) -> Cause:
        return Cause("result", function.name, function.scope.module, function.node)

    def _bound(
        self, name: str, bindings: Iterable[Binding], seen: set[object], module: Module, own: OwnClass | None = None
    ) -> Cause | None:
        bindings = [*bindings]
        inside = own.name if own is not None else ""
        here = Cause("attribute" if inside else "variable", name, module, own.node if own else cst.Name(name), inside)
        if bindings:
            here = Cause(here.kind, name, bindings[0].scope.module, bindings[0].node, inside)
        hints = [each for each in bindings if each.kind == "annotation"]
        if hints:
            return self._hint(hints[0].node, hints[0].scope, here)
        for each in bindings:
            found: Cause | None = None
            if each.kind in ("import", "from"):
                found = self._package(each)
            elif each.kind in ("parameter", "opaque") and isinstance(each.node, cst.Param):
                found = self._parameter(each.node, each.scope)
            elif each.kind in ("value", "element", "enter", "item"):
                found = self._expression(each.node, each.scope, seen)
                is_element = each.kind == "element" and self._inference.infer(each.node, each.scope)
                if (found is None and is_element) or (found is not None and found.kind in ("python", "missing")):
                    found = here
            if found is not None:
                return found
        return None if bindings else here

    def _parameter(self, node: cst.Param, scope: Scope) -> Cause | None:
        function = scope.function
        inside = "a lambda" if function is None or not function.name else function.name
        own = function.own_class if function is not None else None
        if own is not None and function is not None:
            inside = f"{own.name}.{inside}"
        here = Cause("parameter", node.name.value, scope.module, node, inside)
        if node.annotation is not None and function is not None:
            return self._hint(node.annotation.annotation, function.outer, here)
        if isinstance(node.default, cst.BaseNumber | cst.SimpleString) or (
            isinstance(node.default, cst.Name) and node.default.value in ("True", "False")
        ):
            return None
        return here

    def _package(self, binding: Binding) -> Cause | None:
        package = binding.path.partition(".")[0]
        if self._inference.is_own(package):
            return None
        if package in self._inference.table.modules:
            return Cause("python", binding.path, binding.scope.module, binding.node)
        is_python = package in sys.stdlib_module_names
        if is_python and package not in _CARRY_MODULES:
            return None
        imported = binding.path.rpartition(".")[2] if binding.kind == "from" else ""
        kind = "python" if is_python else "package"
        return Cause(kind, package, binding.scope.module, binding.node, imported=imported)

    def _hint(self, node: cst.CSTNode, scope: Scope, here: Cause) -> Cause | None:
        """Return what a hint that names nothing of WPILib's leaves open: what is in a package, or can be anything."""
        if isinstance(node, cst.SimpleString):
            inner = self._inference.parsed(node)
            return None if inner is None else self._hint(inner, scope, here)
        if isinstance(node, cst.Name) and (node.value in _ANYTHING or not scope.find(node.value)):
            return here if node.value in _ANYTHING else None
        if isinstance(node, cst.Attribute | cst.Name):
            if isinstance(node, cst.Attribute) and node.attr.value in _ANYTHING:
                return here
            found = self._expression(node, scope, set())
            return found if found is not None and found.kind == "package" else None
        parts = [node.left, node.right] if isinstance(node, cst.BinaryOperation) else []
        if isinstance(node, cst.Subscript):
            parts = [each.slice.value for each in node.slice if isinstance(each.slice, cst.Index)]
        return next((found for each in parts if (found := self._hint(each, scope, here))), None)
