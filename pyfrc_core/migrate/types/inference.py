"""What each expression of a project can be.

Statements have no order here: a name or attribute is whatever is assigned to it anywhere. What cannot be known is
nothing: the empty set. Parameters without an annotation are what the project's own calls pass.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import libcst as cst

from ...season.names.table import Table
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
    Returns,
    dictionary,
    elements,
    instance,
    items,
    many,
    of_type,
    union,
)
from .passed import Passed
from .scopes import Binding, Module, OwnClass, OwnFunction, Scope, dotted

_TIMES = 6
_AUTONOMOUS = "robotpy_ext.autonomous.StatefulAutonomous"

#: What an annotation puts around one type, or several.
_SINGLE = {"Optional", "Union", "Final", "ClassVar", "Annotated", "Type", "type"}
#: Functions that give what is in their arguments.
_SAME = {
    *("list", "tuple", "set", "sorted", "reversed", "iter", "frozenset", "zip", "enumerate", "filter", "deepcopy"),
    "copy",
}
#: Methods of a dictionary that give what is in it, one by one.
_ITEMS = {"values", "items", "copy"}
#: Methods of a container that give one thing of it.
_ITEM = {"get", "pop", "setdefault", "popleft"}

#: The methods of operators.
_OPERATORS: dict[type[cst.CSTNode], str] = {
    cst.Add: "__add__",
    cst.Subtract: "__sub__",
    cst.Multiply: "__mul__",
    cst.Divide: "__truediv__",
    cst.BitAnd: "__and__",
    cst.BitOr: "__or__",
}


class Inference:
    """The types of a project's expressions.

    :param modules: the project's files
    """

    def __init__(self, table: Table, modules: Sequence[Module]) -> None:
        self.table = table
        self.modules = {module.name: module for module in modules}
        parts = [name.split(".") for name in self.modules]
        self._packages = {".".join(each[:end]) for each in parts for end in range(1, len(each))}
        self._memo: dict[object, Atoms | None] = {}
        #: What was found the last time, for what depends on itself.
        self._before: dict[object, Atoms | None] = {}
        self._parsed: dict[cst.SimpleString, cst.BaseExpression | None] = {}
        self._classes = {each.node: each for module in modules for each in module.classes}
        self._functions = {each.node: each for module in modules for each in module.functions}
        #: The classes that are derived from one of the team's.
        self._below: dict[OwnClass, list[OwnClass]] = {}
        self._passed = Passed(self, self._functions.values(), self._classes.values())
        self._settle()

    def _settle(self) -> None:
        """Infer everything until nothing new is found: what depends on itself needs more than one time."""
        for _ in range(_TIMES):
            for module in self.modules.values():
                for node, scope in module.sites:
                    if isinstance(node, cst.Name | cst.Attribute | cst.Call):
                        self.infer(node, scope)
            self._below = {}
            for own in self._classes.values():
                for base in self.lineage(own)[0][1:]:
                    self._below.setdefault(base, []).append(own)
            settled = self._memo == self._before
            self._before, self._memo = self._memo, {}
            if settled:
                break

    # Expressions

    def infer(self, node: cst.CSTNode, scope: Scope) -> Atoms:
        """Return what an expression can be."""
        return self._once((node, scope), lambda: self._infer(node, scope))

    def _once(self, key: object, find: Callable[[], Atoms]) -> Atoms:
        """Find something once in each turn; what depends on itself is what it was the turn before."""
        if key not in self._memo:
            self._memo[key] = None
            self._memo[key] = find()
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
        return self._once((name, scope), lambda: self._named(name, scope))

    def _named(self, name: str, scope: Scope) -> Atoms:
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
            return self._passed.parameter(binding.node, binding.scope.function)
        if binding.kind == "opaque" and isinstance(binding.node, cst.Param) and binding.node.annotation is not None:
            return many([self.annotated(binding.node.annotation.annotation, binding.scope)])
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
        return self._once(("annotated", node, scope), lambda: self._annotated(node, scope))

    def parsed(self, node: cst.SimpleString) -> cst.BaseExpression | None:
        """Return the annotation that a string is; None if it is none."""
        if node not in self._parsed:
            try:
                self._parsed[node] = cst.parse_expression(str(node.evaluated_value))
            except (cst.ParserSyntaxError, ValueError):
                self._parsed[node] = None
        return self._parsed[node]

    def _annotated(self, node: cst.CSTNode, scope: Scope) -> Atoms:
        if isinstance(node, cst.SimpleString):
            inner_node = self.parsed(node)
            return NOTHING if inner_node is None else self.annotated(inner_node, scope)
        if isinstance(node, cst.BinaryOperation):
            return self.annotated(node.left, scope) | self.annotated(node.right, scope)
        if isinstance(node, cst.Subscript):
            name = node.value.attr.value if isinstance(node.value, cst.Attribute) else getattr(node.value, "value", "")
            inner = [each.slice.value for each in node.slice if isinstance(each.slice, cst.Index)]
            if name == "Callable":
                found = self.annotated(inner[-1], scope) if len(inner) == 2 else NOTHING
                return frozenset({Returns(found)}) if found else NOTHING
            if name.lower() in ("dict", "mapping", "mutablemapping", "defaultdict") and len(inner) == 2:
                return dictionary(self.annotated(inner[0], scope), self.annotated(inner[1], scope))
            found = union(self.annotated(each, scope) for each in inner)
            return found if name in _SINGLE else frozenset({Many(found)}) if found else NOTHING
        found = frozenset(instance(each) for each in self.infer(node, scope) if isinstance(each, Ref | OwnRef))
        if not found and isinstance(node, cst.Name | cst.Attribute):
            found = self._of_the_new_season(node, scope)
        if not found and isinstance(node, cst.Name):  # Alias = Union[A, B]
            aliases = [each for each in scope.find(node.value) if each.kind == "value"]
            found = union(
                self.annotated(each.node, each.scope) for each in aliases if not isinstance(each.node, cst.Name)
            )
        return found

    def _of_the_new_season(self, node: cst.Name | cst.Attribute, scope: Scope) -> Atoms:
        """Return what a class of 2027 is that an annotation names, as the report asks for it: `wpimath.Rotation2d`."""
        head, _, rest = dotted(node).partition(".")
        for binding in scope.find(head) if head else ():
            path = f"{binding.path}.{rest}" if rest else binding.path
            old = [each for each in self.table.before(path.rpartition(".")[2]) if self.table.new_path(each) == path]
            if binding.kind in ("import", "from") and len(old) == 1:
                return frozenset({Obj(old[0])})
        return NOTHING

    # Modules

    def is_own(self, package: str) -> bool:
        """Return whether a module or package is the project's."""
        return package in self.modules or package in self._packages

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

    def family(self, own: OwnClass) -> tuple[list[OwnClass], list[str]]:
        """Return where an object of a class may have its attributes from: the lineage, then that of derived classes.

        What a mixin or a base of the team's uses is often in the classes that are derived from it.
        """
        mine, theirs = self.lineage(own)
        for each in self._below.get(own, ()):
            more, others = self.lineage(each)
            mine += [one for one in more if one not in mine]
            theirs += [one for one in others if one not in theirs]
        return mine, theirs

    def own_bindings(self, own: OwnClass, name: str) -> list[Binding]:
        """Return what a class itself binds as an attribute, in its body and by `self.name = ...`."""
        found = [*own.scope.bindings.get(name, ()), *own.assigned.get(name, ())]
        return found if any(each.kind != "item" for each in found) else []

    def _own_attribute(self, owner: OwnRef | OwnObj, name: str) -> Atoms:
        mine, theirs = self.family(owner.own)
        if isinstance(owner, OwnObj) and owner.above:
            mine = self.lineage(owner.own)[0][1:]
        for own in mine:
            bindings = self.own_bindings(own, name)
            if not bindings:
                continue
            found = union(self.bound(each, name) for each in bindings)
            methods = [each for each in found if isinstance(each, OwnCallable)]
            read = [each for each in methods if {"property", "cached_property"} & each.function.decorators()]
            return found | union(self.returned(each.function) for each in read)
        found = union(self._member(owner, path, name) for path in theirs)
        if not found:  # setattr(self, name, motor)
            found = union(self.bound(each, name) for own in mine for each in own.assigned.get("*", ()))
        return found or (self._passed.components(name) if _AUTONOMOUS in theirs else NOTHING)

    # Calls

    def _call(self, node: cst.Call, scope: Scope) -> Atoms:
        if isinstance(node.func, cst.Name) and not scope.find(node.func.value):
            name = node.func.value
            if name == "super":
                own = scope.class_around()
                return frozenset({OwnObj(own, above=True)}) if own is not None else NOTHING
            if name in _SAME or name in ("next", "max", "min"):
                found = union(self.infer(each.value, scope) for each in node.args)
                self._passed.give_elements(node, scope)
                return found if name in _SAME else elements(found) | found
            if name == "map":
                self._passed.give_elements(node, scope)
                return many(self._result(each) for arg in node.args[:1] for each in self.infer(arg.value, scope))
        called = self.infer(node.func, scope)
        self._passed.give(node, scope, called)
        if isinstance(node.func, cst.Attribute):
            owner = self.infer(node.func.value, scope)
            kept = frozenset(each for each in owner if isinstance(each, Many))
            name = node.func.attr.value
            if kept and name in _ITEMS:
                return kept if name == "copy" else many([items(kept), *([elements(kept)] if name == "items" else [])])
            if kept and name in _ITEM:
                return items(kept)
        return union(self._result(each) for each in called)

    def _result(self, called: Atom) -> Atoms:
        if isinstance(called, Returns):
            return called.of
        if isinstance(called, OwnRef):
            return frozenset({OwnObj(called.own)})
        if isinstance(called, OwnCallable):
            return self.returned(called.function)
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
        return self._results(self.infer(node.left, scope), _OPERATORS.get(type(node.operator), ""))

    def returned(self, function: OwnFunction) -> Atoms:
        """Return what a function of the team's returns."""
        node = function.node
        if isinstance(node, cst.FunctionDef) and node.returns is not None:
            found = self.annotated(node.returns.annotation, function.outer)
            return self.with_stand_ins(found, lambda: self._all_returned(function))
        return self._all_returned(function)

    def _all_returned(self, function: OwnFunction) -> Atoms:
        return union(self.infer(value, scope) for value, scope in function.returned)

    def with_stand_ins(self, annotated: Atoms, given: Callable[[], Atoms]) -> Atoms:
        """Return what is annotated and, where that is a protocol of the team's, what is given in its place."""
        protocols = [each for each in annotated if isinstance(each, OwnObj) and not self.lineage(each.own)[1]]
        return annotated | {each for each in given() if isinstance(each, Obj | OwnObj)} if protocols else annotated
