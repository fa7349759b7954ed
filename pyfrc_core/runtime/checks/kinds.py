"""What an expression in the user's files is: what it calls and the class of its value, from the lines that make it."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from functools import cached_property
from typing import Any

from ...explain.places import last_name
from ...explain.returned import class_of, returned_type
from ...wpi import names
from .sources import SourceFile

#: What makes a command in the methods of a subsystem.
_BY_SUBSYSTEM = re.compile(r"self\.(run|run_?once|run_?end|start_?end|start_?run)", re.IGNORECASE)
#: The commands that go on until something ends them.
_ENDLESS = re.compile(
    r"run|run_?end|start_?end|start_?run|idle|repeatedly|repeating_?sequence|RunCommand|StartEndCommand|RepeatCommand"
)


class Kinds:
    """The objects that the user's files make.

    A name has a class if all lines of its file that assign it make an object of that class; if none does, those of all.
    """

    def __init__(self, sources: list[SourceFile]) -> None:
        self.sources = sources
        self.robot = [each for each in sources if not each.is_test]
        #: By name, in all files ("") and in each.
        self._held: dict[tuple[str, str], type[Any] | None] = {}
        self._functions: dict[str, list[tuple[ast.FunctionDef, SourceFile]]] = {}
        for source in sources:
            for node in source.nodes:
                if isinstance(node, ast.FunctionDef):
                    self._functions.setdefault(node.name, []).append((node, source))
                elif isinstance(node, (ast.Assign, ast.AnnAssign, ast.arg)):
                    self._hold(node, source)

    def _hold(self, node: ast.Assign | ast.AnnAssign | ast.arg, source: SourceFile) -> None:
        value: ast.expr | None = getattr(node, "value", None)
        annotation: ast.expr | None = getattr(node, "annotation", None)
        targets: list[Any] = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", node)]
        if isinstance(value, ast.Constant) and value.value is None:
            return
        found = self.of(value, source) if value is not None else object_of(annotation, source)
        for target in targets:
            name = getattr(target, "arg", "") or last_name(target)
            cls = found if isinstance(found, type) else None
            for key in (("", name), (source.name, name)) if annotation is not None or value is not None else ():
                self._held[key] = cls if self._held.get(key, cls) is cls else None

    def of(self, expression: ast.expr | None, source: SourceFile) -> type[Any] | None:
        """Return the class of an expression's value; None if that is not certain."""
        if not isinstance(expression, ast.Call):
            name = last_name(expression) if expression is not None else ""
            return self._held.get((source.name, name), self._held.get(("", name)))
        called = self.called(expression, source)
        return called if isinstance(called, type) else class_of(returned_type(called))

    def called(self, call: ast.Call, source: SourceFile) -> object:
        """Return the class, function or method that is called; None if that is not certain."""
        found = object_of(call.func, source)
        if found is None and isinstance(call.func, ast.Attribute):
            found = getattr(self.of(call.func.value, source), call.func.attr, None)
        return found

    def owner(self, call: ast.Call, source: SourceFile) -> type[Any] | None:
        """Return the class of the object whose method is called; None if that is not certain."""
        return self.of(call.func.value, source) if isinstance(call.func, ast.Attribute) else None

    def is_library(self, call: ast.Call, source: SourceFile) -> bool:
        """Return whether a method of an object of a library's class is called."""
        owner = self.owner(call, source)
        return owner is not None and owner.__module__.partition(".")[0] in (*names.LIBRARIES, "wpimath", "rev")

    # -- commands --------------------------------------------------------------------------------------------------

    @cached_property
    def decorators(self) -> frozenset[str]:
        """The methods of a command that return another command, such as ``withTimeout``."""
        commands2 = sys.modules.get("commands2")
        methods = vars(getattr(commands2, "Command", object)).items()
        returned = ((name, getattr(each, "__annotations__", {}).get("return")) for name, each in methods)
        return frozenset(
            name for name, each in returned if isinstance(each, str) and _is_command(vars(commands2).get(each))
        )

    def makes_command(self, made: ast.expr, source: SourceFile, calls: int = 3) -> bool:
        """Return whether an expression makes a command."""
        if not isinstance(made, ast.Call):
            return False
        name, maker = last_name(made.func), self.called(made, source)
        if name in self.decorators or _is_command(maker) or getattr(maker, "__module__", None) == "commands2.cmd":
            return True
        if (made.args and _BY_SUBSYSTEM.fullmatch(ast.unparse(made.func))) or self._by_subsystem(made, source):
            return True
        owner = self.owner(made, source)
        if owner is not None and owner.__module__ not in {each.module.__name__ for each in self.sources}:
            return False  # a library's method, with the name of one of the user's
        return any(self.makes_command(each, where, calls - 1) for each, where in self._returned(name, calls))

    def is_endless(self, made: ast.expr, source: SourceFile, calls: int = 3) -> bool:
        """Return whether an expression makes a command that never ends by itself."""
        if not isinstance(made, ast.Call) or not self.makes_command(made, source):
            return False
        name = last_name(made.func)
        return _ENDLESS.fullmatch(name) is not None or any(
            self.is_endless(each, where, calls - 1) for each, where in self._returned(name, calls)
        )

    def returns_nothing(self, name: str) -> bool:
        """Return whether all functions of the user's with this name return nothing, and there are some."""
        found = self._functions.get(name, [])
        return bool(found) and not any(isinstance(node, ast.Return) for each, _ in found for node in ast.walk(each))

    def _by_subsystem(self, made: ast.Call, source: SourceFile) -> bool:
        function = getattr(self.owner(made, source), last_name(made.func), None)
        return getattr(function, "__annotations__", {}).get("return") == "Command"

    def _returned(self, name: str, calls: int) -> Iterator[tuple[ast.expr, SourceFile]]:
        """Yield what a function of the user's returns, if there is one of this name only."""
        found = self._functions.get(name, [])
        for function, source in found if len(found) == 1 and calls else ():
            for each in ast.walk(function):
                if isinstance(each, ast.Return) and each.value is not None:
                    yield each.value, source


def _is_command(maker: object) -> bool:
    return isinstance(maker, type) and any(
        each.__name__ == "Command" and each.__module__.startswith("commands2") for each in maker.__mro__
    )


def object_of(expression: ast.expr | None, source: SourceFile) -> object:
    """Return what a dotted name is in a file; None for anything else."""
    found: object = source.module if expression is not None else None
    for name in ast.unparse(expression).split(".") if expression is not None else ():
        try:
            found = getattr(found, name, None)
        except Exception:  # an attribute of the user's that is computed, and fails
            return None
    return found
