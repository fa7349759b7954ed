"""Which name stands for what: the scopes of a module, and what binds each name in them.

Python's own rules, without the order of statements: a name that is bound twice stands for either.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

import libcst as cst
from libcst.metadata import CodeRange, MetadataWrapper, PositionProvider

#: Methods that put their last argument into a container.
_PUTS = {"add", "append", "appendleft", "insert", "setdefault"}


@dataclass(eq=False)
class Binding:
    """One thing that binds a name.

    :param kind: `import` (a path), `from` (a path), `class`, `function`, `value`, `annotation`, `parameter`,
                 `element` (of a `for`), `enter` (of a `with`), `item` (what is put into a list or dictionary)
    :param scope: where `node` is evaluated
    :param path: of an import
    :param unpacked: the name is one of several that the value is unpacked to
    """

    kind: str
    node: cst.CSTNode
    scope: Scope
    path: str = ""
    unpacked: bool = False


@dataclass(eq=False)
class Scope:
    """A module, class, function or comprehension, and the names bound in it."""

    kind: str
    parent: Scope | None
    module: Module
    bindings: dict[str, list[Binding]] = field(default_factory=dict)
    #: The class of a class scope, or of the method that this function is.
    own_class: OwnClass | None = None
    function: OwnFunction | None = None

    def find(self, name: str) -> Sequence[Binding]:
        """Return what a name stands for here."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.bindings and (scope is self or scope.kind != "class"):
                return scope.bindings[name]
            scope = scope.parent
        return ()

    def class_around(self) -> OwnClass | None:
        """Return the class whose code this is."""
        scope: Scope | None = self
        while scope is not None and scope.kind != "class":
            scope = scope.parent
        return scope.own_class if scope is not None else None


@dataclass(eq=False)
class OwnFunction:
    """A function or method of the team's."""

    node: cst.FunctionDef | cst.Lambda
    scope: Scope
    outer: Scope
    returned: list[tuple[cst.BaseExpression, Scope]] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The function's name; "" for a lambda."""
        return self.node.name.value if isinstance(self.node, cst.FunctionDef) else ""

    @property
    def own_class(self) -> OwnClass | None:
        """The class whose method it is."""
        return self.outer.own_class if self.outer.kind == "class" else None

    def decorators(self) -> set[str]:
        """Return the last part of the name of each decorator."""
        found = set()
        for each in self.node.decorators if isinstance(self.node, cst.FunctionDef) else ():
            node = each.decorator.func if isinstance(each.decorator, cst.Call) else each.decorator
            found.add(dotted(node).rpartition(".")[2])
        return found

    def receives_self(self) -> bool:
        """Return whether the first parameter is the object, or the class, whose method it is."""
        return self.own_class is not None and bool(self.parameters()) and "staticmethod" not in self.decorators()

    def parameters(self) -> list[cst.Param]:
        """Return all parameters but `*args` and `**kwargs`."""
        of = self.node.params
        return [*of.posonly_params, *of.params, *of.kwonly_params]


@dataclass(eq=False)
class OwnClass:
    """A class of the team's, and what its methods assign to `self`."""

    node: cst.ClassDef
    scope: Scope
    outer: Scope
    assigned: dict[str, list[Binding]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The class's name."""
        return self.node.name.value


@dataclass(eq=False)
class Module:
    """A file of the project.

    :param name: how the project's modules import it
    :raises RecursionError: when it is nested too deeply
    """

    path: Path
    name: str
    tree: cst.Module
    scope: Scope = field(init=False)
    positions: Mapping[cst.CSTNode, CodeRange] = field(init=False)
    #: Expressions and statements that may name something of WPILib, with the scope they are in.
    sites: list[tuple[cst.CSTNode, Scope]] = field(default_factory=list)
    classes: list[OwnClass] = field(default_factory=list)
    functions: list[OwnFunction] = field(default_factory=list)
    #: Strings that are annotations.
    annotations: list[tuple[cst.SimpleString, Scope]] = field(default_factory=list)
    #: What is called.
    called: set[cst.CSTNode] = field(default_factory=set)
    #: Calls whose result is indexed.
    subscripted: set[cst.CSTNode] = field(default_factory=set)
    #: The scope of each part of a comprehension.
    comprehensions: dict[cst.CSTNode, Scope] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.scope = Scope("module", None, self)
        wrapper = MetadataWrapper(self.tree, unsafe_skip_copy=True)
        self.positions = cast("Mapping[cst.CSTNode, CodeRange]", wrapper.resolve(PositionProvider))
        self.tree.visit(_Builder(self))


def dotted(node: cst.BaseExpression | None) -> str:
    """Return `a.b.c` of a chain of names, or "" for any other expression."""
    if isinstance(node, cst.Name):
        return node.value
    if isinstance(node, cst.Attribute):
        head = dotted(node.value)
        return f"{head}.{node.attr.value}" if head else ""
    return ""


class _Builder(cst.CSTVisitor):
    def __init__(self, module: Module) -> None:
        self._module = module
        self._scope = module.scope
        self._annotating = False

    def _site(self, node: cst.CSTNode) -> None:
        self._module.sites.append((node, self._scope))

    def _bind(self, name: str, kind: str, node: cst.CSTNode, path: str = "", unpacked: bool = False) -> None:
        self._scope.bindings.setdefault(name, []).append(Binding(kind, node, self._scope, path, unpacked))

    # Names and calls

    def visit_Name(self, node: cst.Name) -> None:
        self._site(node)

    def visit_Attribute(self, node: cst.Attribute) -> bool:
        self._site(node)
        node.value.visit(self)
        return False

    def visit_Arg(self, node: cst.Arg) -> bool:
        node.value.visit(self)
        return False

    def visit_Call(self, node: cst.Call) -> None:
        self._site(node)
        self._module.called.add(node.func)
        if isinstance(node.func, cst.Attribute) and node.func.attr.value in _PUTS and node.args:
            self._put(node.func.value, node.args[-1].value)
        if isinstance(node.func, cst.Name) and node.func.value == "setattr" and len(node.args) == 3:
            self._set(*(each.value for each in node.args))

    def _set(self, owner: cst.BaseExpression, name: cst.BaseExpression, value: cst.BaseExpression) -> None:
        """Note what `setattr(self, name, value)` assigns, under "*" if the name is made while the robot runs."""
        own = self._self_class(owner.value) if isinstance(owner, cst.Name) else None
        if own is not None:
            text = str(name.evaluated_value) if isinstance(name, cst.SimpleString) else "*"
            own.assigned.setdefault(text, []).append(Binding("value", value, self._scope))

    def visit_Comparison(self, node: cst.Comparison) -> None:
        self._site(node)

    def visit_Expr(self, node: cst.Expr) -> None:
        self._site(node)

    def visit_BinaryOperation(self, node: cst.BinaryOperation) -> None:
        self._site(node)

    def visit_Subscript(self, node: cst.Subscript) -> None:
        self._module.subscripted.add(node.value)
        self._site(node)

    def visit_SimpleString(self, node: cst.SimpleString) -> None:
        if self._annotating:
            self._module.annotations.append((node, self._scope))
        else:
            self._site(node)

    def visit_Annotation(self, node: cst.Annotation) -> bool:
        self._annotating = True
        node.annotation.visit(self)
        self._annotating = False
        return False

    # Imports

    def visit_Import(self, node: cst.Import) -> bool:
        self._site(node)
        for alias in node.names:
            path = dotted(alias.name) if isinstance(alias.name, cst.Attribute) else alias.name.value
            if alias.asname is not None and isinstance(alias.asname.name, cst.Name):
                self._bind(alias.asname.name.value, "import", node, path)
            else:
                self._bind(path.split(".")[0], "import", node, path.split(".")[0])
        return False

    def visit_ImportFrom(self, node: cst.ImportFrom) -> bool:
        self._site(node)
        source = import_source(node, self._module)
        if isinstance(node.names, cst.ImportStar):
            self._bind("*", "from", node, source)
            return False
        for alias in node.names:
            name = dotted(alias.name)
            asname = alias.asname.name.value if alias.asname and isinstance(alias.asname.name, cst.Name) else name
            self._bind(asname, "from", node, f"{source}.{name}")
        return False

    # Assignments

    def visit_Assign(self, node: cst.Assign) -> None:
        self._site(node)
        for target in node.targets:
            self._assign(target.target, "value", node.value)

    def visit_AnnAssign(self, node: cst.AnnAssign) -> None:
        self._assign(node.target, "annotation", node.annotation.annotation)
        if node.value is not None:
            self._assign(node.target, "value", node.value)

    def visit_NamedExpr(self, node: cst.NamedExpr) -> None:
        self._assign(node.target, "value", node.value)

    def visit_For(self, node: cst.For) -> None:
        self._assign(node.target, "element", node.iter)

    def visit_With(self, node: cst.With) -> None:
        for item in node.items:
            if item.asname is not None:
                self._assign(item.asname.name, "enter", item.item)

    def _assign(self, target: cst.BaseExpression, kind: str, value: cst.CSTNode, unpacked: bool = False) -> None:
        if isinstance(target, cst.Name):
            self._bind(target.value, kind, value, unpacked=unpacked)
        elif isinstance(target, cst.Tuple | cst.List):
            pairs = value.elements if isinstance(value, cst.Tuple | cst.List) and kind == "value" else ()
            for position, element in enumerate(target.elements):
                if len(pairs) == len(target.elements):
                    self._assign(element.value, kind, pairs[position].value, unpacked)
                else:
                    self._assign(element.value, kind, value, True)
        elif isinstance(target, cst.Attribute) and isinstance(target.value, cst.Name):
            owner = self._self_class(target.value.value)
            if owner is not None:
                found = owner.assigned.setdefault(target.attr.value, [])
                found.append(Binding(kind, value, self._scope, "", unpacked))
        elif isinstance(target, cst.Subscript) and kind == "value" and not unpacked:
            self._put(target.value, value)

    def _put(self, container: cst.BaseExpression, value: cst.CSTNode) -> None:
        """Note what is put into a list or dictionary, where its own name is bound."""
        if isinstance(container, cst.Attribute):
            self._assign(container, "item", value)
        elif isinstance(container, cst.Name):
            bindings = self._scope.find(container.value)
            if bindings and all(each.kind in ("value", "item") for each in bindings):
                bindings[0].scope.bindings[container.value].append(Binding("item", value, self._scope))

    def _self_class(self, name: str) -> OwnClass | None:
        scope: Scope | None = self._scope
        while scope is not None and scope.function is not None:
            function = scope.function
            parameters = function.parameters()
            if function.own_class is not None and parameters and parameters[0].name.value == name:
                return function.own_class
            scope = scope.parent
        return None

    # Scopes

    def visit_ClassDef(self, node: cst.ClassDef) -> bool:
        self._site(node)
        for each in (*node.decorators, *node.bases, *node.keywords):
            each.visit(self)
        scope = Scope("class", self._scope, self._module)
        scope.own_class = OwnClass(node, scope, self._scope)
        self._module.classes.append(scope.own_class)
        self._bind(node.name.value, "class", node)
        self._scope.bindings[node.name.value][-1].scope = scope
        self._inside(scope, [node.body])
        return False

    def visit_FunctionDef(self, node: cst.FunctionDef) -> bool:
        self._site(node)
        for each in node.decorators:
            each.visit(self)
        function = self._function(node)
        self._bind(node.name.value, "function", node)
        self._scope.bindings[node.name.value][-1].scope = function.scope
        if node.returns is not None:
            node.returns.visit(self)
        self._inside(function.scope, [node.body])
        return False

    def visit_Lambda(self, node: cst.Lambda) -> bool:
        function = self._function(node)
        function.returned.append((node.body, function.scope))
        self._inside(function.scope, [node.body])
        return False

    def _function(self, node: cst.FunctionDef | cst.Lambda) -> OwnFunction:
        scope = Scope("function", self._scope, self._module)
        function = OwnFunction(node, scope, self._scope)
        scope.function = function
        self._module.functions.append(function)
        of = node.params
        stars = [each for each in (of.star_arg, of.star_kwarg) if isinstance(each, cst.Param)]
        for each in [*function.parameters(), *stars]:
            if each.annotation is not None:
                each.annotation.visit(self)
            if each.default is not None:
                each.default.visit(self)
            kind = "opaque" if each in stars else "parameter"
            scope.bindings.setdefault(each.name.value, []).append(Binding(kind, each, scope))
        return function

    def visit_Return(self, node: cst.Return) -> None:
        if node.value is not None and self._scope.function is not None:
            self._scope.function.returned.append((node.value, self._scope))

    def visit_Yield(self, node: cst.Yield) -> None:
        # A fixture gives its test what it yields.
        function = self._scope.function
        if isinstance(node.value, cst.BaseExpression) and function is not None and "fixture" in function.decorators():
            function.returned.append((node.value, self._scope))

    def visit_ListComp(self, node: cst.ListComp) -> bool:
        self._site(node)
        return self._comprehension(node.for_in, [node.elt])

    def visit_SetComp(self, node: cst.SetComp) -> bool:
        return self._comprehension(node.for_in, [node.elt])

    def visit_GeneratorExp(self, node: cst.GeneratorExp) -> bool:
        return self._comprehension(node.for_in, [node.elt])

    def visit_DictComp(self, node: cst.DictComp) -> bool:
        return self._comprehension(node.for_in, [node.key, node.value])

    def _comprehension(self, first: cst.CompFor, parts: Sequence[cst.CSTNode]) -> bool:
        scope = Scope("comprehension", self._scope, self._module, function=self._scope.function)
        inner = [*parts]
        for each in _loops(first):
            inner += [each.iter, each.target, *(clause.test for clause in each.ifs)]
        outer, self._scope = self._scope, scope
        for each in _loops(first):
            self._assign(each.target, "element", each.iter)
        for part in inner:
            part.visit(self)
            self._module.comprehensions[part] = scope
        self._scope = outer
        return False

    def _inside(self, scope: Scope, parts: Sequence[cst.CSTNode]) -> None:
        outer, self._scope = self._scope, scope
        for part in parts:
            part.visit(self)
        self._scope = outer


def _loops(first: cst.CompFor) -> Iterator[cst.CompFor]:
    each: cst.CompFor | None = first
    while each is not None:
        yield each
        each = each.inner_for_in


#: The packages of WPILib, and REV's, that have private modules.
_BINDINGS = {"hal", "ntcore", "rev", "robotpy_apriltag", "wpilib", "wpimath", "wpinet", "wpiutil"}


def import_source(node: cst.ImportFrom, module: Module) -> str:
    """Return the module of a `from` import; a relative one as the project's modules import it.

    Editors import names of WPILib from its private modules, such as ``wpimath.geometry._geometry``: the public one has
    them, too.
    """
    source = dotted(node.module) if node.module is not None else ""
    if not node.relative:
        parts = source.split(".")
        return ".".join(part for part in parts if part[:1] != "_") if parts[0] in _BINDINGS else source
    parts = module.name.split(".")
    cut = len(node.relative) - (1 if module.path.name == "__init__.py" else 0)
    parts = parts[: len(parts) - cut] if cut else parts
    return ".".join([*parts, *([source] if source else [])])
