"""What each expression of a project can be.

Statements have no order here: a name or attribute is whatever is assigned to it anywhere. What cannot be known is
nothing: the empty set. Parameters without an annotation are what the project's own calls pass.
"""

from __future__ import annotations

from collections.abc import Sequence

import libcst as cst

from ..names.table import Table
from .atoms import (
    NOTHING,
    Atom,
    Atoms,
    Bound,
    Many,
    Obj,
    OwnCallable,
    OwnModuleRef,
    OwnObj,
    OwnRef,
    Ref,
    dictionary,
    elements,
    instance,
    items,
    many,
    of_type,
    union,
)
from .library import ITEM, ITEMS, OPERATORS, SAME, SINGLE
from .scopes import Binding, Module, OwnClass, OwnFunction, Scope
from .values import values

_TIMES = 4
_AUTONOMOUS = "robotpy_ext.autonomous.StatefulAutonomous"


class Inference:
    """The types of a project's expressions.

    :param modules: the project's files
    """

    def __init__(self, table: Table, modules: Sequence[Module]) -> None:
        self.table = table
        self.modules = {module.name: module for module in modules}
        self._packages = {name.rpartition(".")[0] for name in self.modules if "." in name}
        self._memo: dict[object, Atoms | None] = {}
        #: What was found the last time, for what depends on itself.
        self._before: dict[object, Atoms | None] = {}
        self._classes = {each.node: each for module in modules for each in module.classes}
        self._functions = {each.node: each for module in modules for each in module.functions}
        self._calls: dict[str, list[tuple[cst.Call, Scope]]] = {}
        #: The call that a lambda is passed to.
        self._receivers: dict[cst.CSTNode, tuple[cst.Call, Scope]] = {}
        for module in modules:
            for node, scope in module.sites:
                if isinstance(node, cst.Call):
                    self._receivers |= {
                        arg.value: (node, scope) for arg in node.args if isinstance(arg.value, cst.Lambda)
                    }
                if isinstance(node, cst.Call) and isinstance(node.func, cst.Name | cst.Attribute):
                    name = node.func.value if isinstance(node.func, cst.Name) else node.func.attr.value
                    self._calls.setdefault(name, []).append((node, scope))

        self._settle()

    def _settle(self) -> None:
        """Infer everything until nothing new is found: what depends on itself needs more than one time."""
        for _ in range(_TIMES):
            for module in self.modules.values():
                for node, scope in module.sites:
                    if isinstance(node, cst.Name | cst.Attribute | cst.Call):
                        self.infer(node, scope)
            settled = self._memo == self._before
            self._before, self._memo = self._memo, {}
            if settled:
                break

    # Expressions

    def infer(self, node: cst.CSTNode, scope: Scope) -> Atoms:
        """Return what an expression can be."""
        key = (node, scope)
        if key not in self._memo:
            self._memo[key] = None
            self._memo[key] = self._infer(node, scope)
        found = self._memo[key]
        return (self._before.get(key) or NOTHING) if found is None else found

    def _infer(self, node: cst.CSTNode, scope: Scope) -> Atoms:
        if isinstance(node, cst.Name):
            return self.named(node.value, scope)
        if isinstance(node, cst.Attribute):
            return self.attribute(self.infer(node.value, scope), node.attr.value)
        if isinstance(node, cst.Call):
            return self._call(node, scope)
        if isinstance(node, cst.Await):
            return self.infer(node.expression, scope)
        if isinstance(node, cst.NamedExpr):
            return self.infer(node.value, scope)
        if isinstance(node, cst.IfExp):
            return self.infer(node.body, scope) | self.infer(node.orelse, scope)
        if isinstance(node, cst.BooleanOperation):
            return self.infer(node.left, scope) | self.infer(node.right, scope)
        if isinstance(node, cst.BinaryOperation):
            return self._operation(node, scope)
        if isinstance(node, cst.UnaryOperation):
            name = "__invert__" if isinstance(node.operator, cst.BitInvert) else "__neg__"
            return self._results(self.infer(node.expression, scope), name)
        if isinstance(node, cst.Tuple | cst.List | cst.Set):
            return many(self.infer(each.value, scope) for each in node.elements)
        if isinstance(node, cst.Dict):
            keys = [each.key for each in node.elements if isinstance(each, cst.DictElement)]
            return dictionary(
                union(self.infer(each, scope) for each in keys),
                union(self.infer(each.value, scope) for each in node.elements),
            )
        if isinstance(node, cst.DictComp):
            inner = scope.module.comprehensions.get(node.key, scope)
            return dictionary(self.infer(node.key, inner), self.infer(node.value, inner))
        if isinstance(node, cst.ListComp | cst.SetComp | cst.GeneratorExp):
            return many([self.infer(node.elt, scope.module.comprehensions.get(node.elt, scope))])
        if isinstance(node, cst.Subscript):
            found = self.infer(node.value, scope)
            generic = frozenset(each for each in found if isinstance(each, OwnRef | Ref))
            return items(found) | self._results(found, "__getitem__") | generic
        if isinstance(node, cst.Lambda):
            return frozenset({OwnCallable(self._functions[node])}) if node in self._functions else NOTHING
        return NOTHING

    def named(self, name: str, scope: Scope) -> Atoms:
        """Return what a name can be in a scope."""
        bindings = scope.find(name)
        if bindings:
            return union(self.bound(each, name) for each in bindings)
        stars = scope.module.scope.bindings.get("*", ())
        return union(self._member_of_module(each.path, name) for each in stars)

    def bound(self, binding: Binding, name: str) -> Atoms:
        """Return what a binding gives its name."""
        found: Atoms = NOTHING
        if binding.kind == "import":
            return self._module(binding.path)
        if binding.kind == "from":
            return self._imported(binding.path)
        if binding.kind == "class" and isinstance(binding.node, cst.ClassDef):
            return frozenset({OwnRef(self._classes[binding.node])})
        if binding.kind == "function" and isinstance(binding.node, cst.FunctionDef):
            return frozenset({OwnCallable(self._functions[binding.node])})
        if binding.kind == "parameter" and isinstance(binding.node, cst.Param) and binding.scope.function is not None:
            return self._parameter(binding.node, binding.scope.function)
        if binding.kind == "annotation":
            return self.annotated(binding.node, binding.scope)
        if binding.kind in ("value", "element", "enter"):
            found = self.infer(binding.node, binding.scope)
            if binding.kind == "element":
                found = elements(found)
            if binding.unpacked:
                found = elements(found) | found
        if binding.kind == "item":
            found = many([self.infer(binding.node, binding.scope)])
        return found

    def annotated(self, node: cst.CSTNode, scope: Scope) -> Atoms:
        """Return what an object with this annotation can be."""
        if isinstance(node, cst.SimpleString):
            try:
                return self.annotated(cst.parse_expression(str(node.evaluated_value)), scope)
            except cst.ParserSyntaxError:
                return NOTHING
        if isinstance(node, cst.BinaryOperation):
            return self.annotated(node.left, scope) | self.annotated(node.right, scope)
        if isinstance(node, cst.Subscript):
            name = node.value.attr.value if isinstance(node.value, cst.Attribute) else getattr(node.value, "value", "")
            inner = [each.slice.value for each in node.slice if isinstance(each.slice, cst.Index)]
            if name == "Callable":
                return NOTHING
            if name.lower() in ("dict", "mapping", "mutablemapping", "defaultdict") and len(inner) == 2:
                return dictionary(self.annotated(inner[0], scope), self.annotated(inner[1], scope))
            found = union(self.annotated(each, scope) for each in inner)
            return found if name in SINGLE else frozenset({Many(found)}) if found else NOTHING
        found = frozenset(instance(each) for each in self.infer(node, scope) if isinstance(each, Ref | OwnRef))
        if not found and isinstance(node, cst.Name):  # Alias = Union[A, B]
            aliases = [each for each in scope.find(node.value) if each.kind == "value"]
            found = union(
                self.annotated(each.node, each.scope) for each in aliases if not isinstance(each.node, cst.Name)
            )
        return found

    # Modules

    def _module(self, path: str) -> Atoms:
        if path in self.modules or path in self._packages:
            return frozenset({OwnModuleRef(path, self.modules.get(path))})
        return frozenset({Ref(path)}) if path in self.table.modules else NOTHING

    def _imported(self, path: str) -> Atoms:
        found = self._module(path)
        module, _, name = path.rpartition(".")
        return found or self._member_of_module(module, name)

    def _member_of_module(self, module: str, name: str) -> Atoms:
        return union(self.attribute(frozenset({each}), name) for each in self._module(module))

    # Attributes

    def attribute(self, owners: Atoms, name: str) -> Atoms:
        """Return what an attribute of any of these can be."""
        return union(self._attribute(each, name) for each in owners)

    def _attribute(self, owner: Atom, name: str) -> Atoms:
        if isinstance(owner, OwnModuleRef):
            inner = self._module(f"{owner.name}.{name}")
            return inner if inner or owner.module is None else self.named(name, owner.module.scope)
        if isinstance(owner, OwnRef | OwnObj):
            return self._own_attribute(owner, name)
        if isinstance(owner, Ref):
            path = f"{owner.path}.{name}"
            if path in self.table.modules or self.table.name(path) is not None:
                return frozenset({Ref(self.table.canonical(path))})
            return self._member(owner, owner.path, name)
        return self._member(owner, owner.path, name) if isinstance(owner, Obj) else NOTHING

    def _member(self, receiver: Atom, path: str, name: str) -> Atoms:
        for each in self.table.ancestors(path):
            nested = f"{each}.{name}"
            if self.table.name(nested) is not None:
                return frozenset({Ref(nested)})
        found = self.table.member(path, name)
        if found is None:
            return NOTHING
        owner, member = found
        # A method, or a value of the type: the table does not say which, and only one of them makes sense.
        return frozenset({Bound(owner, name, receiver)}) | of_type(member.type, receiver, values_only=True)

    def own_bases(self, own: OwnClass) -> list[OwnRef | Ref]:
        """Return the classes that a class of the team's is derived from directly."""
        atoms = [atom for each in own.node.bases for atom in self.infer(each.value, own.outer)]
        return [each for each in atoms if isinstance(each, OwnRef | Ref)]

    def lineage(self, own: OwnClass) -> tuple[list[OwnClass], list[str]]:
        """Return a class and its bases: the team's, and WPILib's by their paths."""
        mine, theirs = [own], []
        for each in mine:
            for base in self.own_bases(each):
                if isinstance(base, Ref):
                    theirs.append(base.path)
                elif base.own not in mine:
                    mine.append(base.own)
        return mine, theirs

    def own_bindings(self, own: OwnClass, name: str) -> list[Binding]:
        """Return what a class itself binds as an attribute, in its body and by `self.name = ...`."""
        found = [*own.scope.bindings.get(name, ()), *own.assigned.get(name, ())]
        return found if any(each.kind != "item" for each in found) else []

    def _own_attribute(self, owner: OwnRef | OwnObj, name: str) -> Atoms:
        mine, theirs = self.lineage(owner.own)
        if isinstance(owner, OwnObj) and owner.above:
            mine = mine[1:]
        for own in mine:
            bindings = self.own_bindings(own, name)
            if not bindings:
                continue
            found = union(self.bound(each, name) for each in bindings)
            methods = [each for each in found if isinstance(each, OwnCallable)]
            read = [each for each in methods if {"property", "cached_property"} & each.function.decorators()]
            return found | union(self._returned(each.function) for each in read)
        found = union(self._member(owner, path, name) for path in theirs)
        return found or (self._components(name) if _AUTONOMOUS in theirs else NOTHING)

    def _components(self, name: str) -> Atoms:
        """Return what the robot gives its autonomous modes under a name."""
        found: Atoms = NOTHING
        for call, scope in self._calls.get("AutonomousModeSelector", ()):
            for arg in call.args:
                dictionaries = [arg.value, *values(self, arg.value, scope)]
                for each in dictionaries:
                    if isinstance(each, cst.Dict):
                        found |= union(
                            self.infer(item.value, scope)
                            for item in each.elements
                            if isinstance(item, cst.DictElement)
                            and isinstance(item.key, cst.SimpleString)
                            and item.key.evaluated_value == name
                        )
        return found

    # Calls

    def _call(self, node: cst.Call, scope: Scope) -> Atoms:
        if isinstance(node.func, cst.Name) and not scope.find(node.func.value):
            name = node.func.value
            if name == "super":
                own = scope.class_around()
                return frozenset({OwnObj(own, above=True)}) if own is not None else NOTHING
            if name in SAME or name in ("next", "max", "min"):
                found = union(self.infer(each.value, scope) for each in node.args)
                return found if name in SAME else elements(found) | found
        called = self.infer(node.func, scope)
        if isinstance(node.func, cst.Attribute):
            owner = self.infer(node.func.value, scope)
            kept = frozenset(each for each in owner if isinstance(each, Many))
            name = node.func.attr.value
            if kept and name in ITEMS:
                return kept if name == "copy" else many([items(kept), *([elements(kept)] if name == "items" else [])])
            if kept and name in ITEM:
                return items(kept)
        return union(self._result(each) for each in called)

    def _result(self, called: Atom) -> Atoms:
        if isinstance(called, OwnRef):
            return frozenset({OwnObj(called.own)})
        if isinstance(called, OwnCallable):
            return self._returned(called.function)
        if isinstance(called, Ref):
            name = self.table.name(called.path)
            if name is None:
                return NOTHING
            return frozenset({Obj(called.path)}) if name.is_class else of_type(name.type, called)
        if isinstance(called, Bound):
            found = self.table.member(called.owner, called.name)
            return NOTHING if found is None else of_type(found[1].type, called.receiver)
        return NOTHING

    def _results(self, owners: Atoms, method: str) -> Atoms:
        return union(self._result(each) for each in self.attribute(owners, method))

    def _operation(self, node: cst.BinaryOperation, scope: Scope) -> Atoms:
        name = OPERATORS.get(type(node.operator), "")
        left, right = self.infer(node.left, scope), self.infer(node.right, scope)
        return self._results(left, name) | self._results(right, name.replace("__", "__r", 1))

    def _returned(self, function: OwnFunction) -> Atoms:
        node = function.node
        if isinstance(node, cst.FunctionDef) and node.returns is not None:
            return self.annotated(node.returns.annotation, function.outer)
        return union(self.infer(value, scope) for value, scope in function.returned)

    # Parameters

    def _parameter(self, node: cst.Param, function: OwnFunction) -> Atoms:
        own, parameters = function.own_class, function.parameters()
        if own is not None and parameters and node is parameters[0] and "staticmethod" not in function.decorators():
            return frozenset({OwnRef(own) if "classmethod" in function.decorators() else OwnObj(own)})
        if node.annotation is not None:
            return self.annotated(node.annotation.annotation, function.outer)
        found = self.infer(node.default, function.outer) if node.default is not None else NOTHING
        found |= self._passed(node, function)
        return found or self._from_callback(function) or self._fixture(node.name.value)

    def _from_callback(self, function: OwnFunction) -> Atoms:
        """Return what WPILib passes to a lambda."""
        call, scope = self._receivers.get(function.node, (None, None))
        if call is None or scope is None:
            return NOTHING
        paths = [f"{each.owner}.{each.name}" for each in self.infer(call.func, scope) if isinstance(each, Bound)]
        types = self.table.corrections["callbacks"]
        return frozenset(Obj(types[path]) for path in paths if path in types)

    def _passed(self, node: cst.Param, function: OwnFunction) -> Atoms:
        """Return what the project's own calls pass for a parameter."""
        own = function.own_class
        is_constructor = own is not None and function.name == "__init__"
        position = function.parameters().index(node) - (1 if own is not None else 0)
        found: Atoms = NOTHING
        for call, scope in self._calls.get(own.name if is_constructor and own else function.name, ()):
            wanted: Atom = OwnRef(own) if is_constructor and own is not None else OwnCallable(function)
            if wanted not in self.infer(call.func, scope):
                continue
            for index, arg in enumerate(call.args):
                if arg.star:
                    break
                if arg.keyword.value == node.name.value if arg.keyword else index == position:
                    found |= self.infer(arg.value, scope)
        return found

    def _fixture(self, name: str) -> Atoms:
        """Return what pytest, or pyfrc, passes for a parameter of this name."""
        fixtures = [each for each in self._functions.values() if each.name == name and "fixture" in each.decorators()]
        if fixtures:
            return union(self._returned(each) for each in fixtures)
        if name == "physics_controller":
            return frozenset({Obj("pyfrc.physics.core.PhysicsInterface")})
        return self._robots() if name == "robot" else NOTHING

    def _robots(self) -> Atoms:
        """Return the robot classes: what tests and physics.py call `robot`."""
        robots = [
            own
            for own in self._classes.values()
            if any("wpilib.RobotBase" in self.table.ancestors(path) for path in self.lineage(own)[1])
        ]
        return frozenset(OwnObj(each) for each in robots)
