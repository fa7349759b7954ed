"""What the parameters of a project's functions are: what is annotated, or what calls, WPILib and pytest pass."""

from __future__ import annotations

from collections.abc import Collection, Iterable

import libcst as cst

from .atoms import NOTHING, Atom, Atoms, Bound, Obj, OwnCallable, OwnObj, OwnRef, elements, items, union
from .scopes import OwnClass, OwnFunction, Scope
from .values import Types, values


class Passed:
    """The parameters of a project's functions.

    :param functions: all of the project
    """

    def __init__(self, inference: Types, functions: Collection[OwnFunction], classes: Collection[OwnClass]) -> None:
        self._inference = inference
        self._functions = functions
        self._classes = classes
        self._calls: dict[str, list[tuple[cst.Call, Scope]]] = {}
        #: The call that a lambda is passed to.
        self._receivers: dict[cst.CSTNode, tuple[cst.Call, Scope]] = {}
        #: What is passed to a function that is called by another name than its own, by the parameter.
        self._given: dict[cst.Param, Atoms] = {}
        for module in inference.modules.values():
            for node, scope in module.sites:
                if isinstance(node, cst.Call):
                    lambdas = [arg.value for arg in node.args if isinstance(arg.value, cst.Lambda)]
                    self._receivers |= dict.fromkeys(lambdas, (node, scope))
                    self._calls.setdefault(_called_name(node), []).append((node, scope))

    def parameter(self, node: cst.Param, function: OwnFunction) -> Atoms:
        """Return what a parameter can be."""
        own = function.own_class
        if own is not None and function.receives_self() and node is function.parameters()[0]:
            return frozenset({OwnRef(own) if "classmethod" in function.decorators() else OwnObj(own)})
        if node.annotation is not None:
            annotated = self._inference.annotated(node.annotation.annotation, function.outer)
            return self._inference.with_stand_ins(annotated, lambda: self._passed(node, function))
        found = self._inference.infer(node.default, function.outer) if node.default is not None else NOTHING
        found |= self._passed(node, function)
        return found or self._from_callback(function) or self._fixture(node.name.value)

    def give(self, call: cst.Call, scope: Scope, called: Atoms) -> None:
        """Note what a call passes to a lambda, or to a function by another name than its own."""
        for each in called:
            if isinstance(each, OwnCallable) and each.function.name != _called_name(call):
                self._give(each.function, [self._inference.infer(arg.value, scope) for arg in call.args])

    def give_elements(self, call: cst.Call, scope: Scope) -> None:
        """Note what `map` and its relatives pass to the functions that they get."""
        passed = [self._inference.infer(arg.value, scope) for arg in call.args]
        functions = [each.function for atoms in passed for each in atoms if isinstance(each, OwnCallable)]
        others = [elements(each) for each in passed if elements(each)]
        for each in functions:
            self._give(each, others)

    def _give(self, function: OwnFunction, arguments: Iterable[Atoms]) -> None:
        parameters = function.parameters()[1 if function.receives_self() else 0 :]
        for parameter, atoms in zip(parameters, arguments, strict=False):
            self._given[parameter] = self._given.get(parameter, NOTHING) | atoms

    def _from_callback(self, function: OwnFunction) -> Atoms:
        """Return what WPILib passes to a lambda."""
        call, scope = self._receivers.get(function.node, (None, None))
        if call is None or scope is None:
            return NOTHING
        called = self._inference.infer(call.func, scope)
        paths = [f"{each.owner}.{each.name}" for each in called if isinstance(each, Bound)]
        types = self._inference.table.corrections["callbacks"]
        return frozenset(Obj(types[path]) for path in paths if path in types)

    def _passed(self, node: cst.Param, function: OwnFunction) -> Atoms:
        """Return what the project's own calls pass for a parameter."""
        own = function.own_class
        is_constructor = own is not None and function.name == "__init__"
        position = function.parameters().index(node) - (1 if function.receives_self() else 0)
        found = self._given.get(node, NOTHING)
        for call, scope in self._calls.get(own.name if is_constructor and own else function.name, ()):
            wanted: Atom = OwnRef(own) if is_constructor and own is not None else OwnCallable(function)
            if wanted not in self._inference.infer(call.func, scope):
                continue
            several = False  # f(*motors)
            for index, arg in enumerate(call.args):
                if arg.star:
                    several = several or (arg.star == "*" and index <= position)
                    found |= items(self._inference.infer(arg.value, scope))
                elif arg.keyword.value == node.name.value if arg.keyword else index == position and not several:
                    found |= self._inference.infer(arg.value, scope)
        return found

    def _fixture(self, name: str) -> Atoms:
        """Return what pytest, or pyfrc, passes for a parameter of this name."""
        fixtures = [each for each in self._functions if each.name == name and "fixture" in each.decorators()]
        if fixtures:
            return union(self._inference.returned(each) for each in fixtures)
        if name == "physics_controller":
            return frozenset({Obj("pyfrc.physics.core.PhysicsInterface")})
        return self._robots() if name == "robot" else NOTHING

    def _robots(self) -> Atoms:
        """Return the robot classes: what tests and physics.py call `robot`."""
        ancestors = self._inference.table.ancestors
        return frozenset(
            OwnObj(own)
            for own in self._classes
            if any("wpilib.RobotBase" in ancestors(path) for path in self._inference.lineage(own)[1])
        )

    def components(self, name: str) -> Atoms:
        """Return what the robot gives its autonomous modes under a name, by magicbot's `AutonomousModeSelector`."""
        found: Atoms = NOTHING
        for call, scope in self._calls.get("AutonomousModeSelector", ()):
            for arg in call.args:
                for each in (arg.value, *values(self._inference, arg.value, scope)):
                    for item in each.elements if isinstance(each, cst.Dict) else ():
                        key = item.key if isinstance(item, cst.DictElement) else None
                        if isinstance(key, cst.SimpleString) and key.evaluated_value == name:
                            found |= self._inference.infer(item.value, scope)
        return found


def _called_name(call: cst.Call) -> str:
    func = call.func
    return func.value if isinstance(func, cst.Name) else func.attr.value if isinstance(func, cst.Attribute) else ""
