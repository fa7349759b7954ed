"""The project's imported files, as syntax trees, for the checks that read code, and what these return."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from ...explain.places import parsed
from ...project import Project
from ...project.loaded_modules import loaded_modules

Node = TypeVar("Node", bound=ast.AST)


@dataclass(frozen=True)
class CodeWarning:
    """A mistake in robot code that raises no error here.

    :param where: ``robot.py:12``
    :param text: the problem in one sentence, without its place
    :param remedy: the remedy in one sentence
    """

    where: str
    text: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.where}: {self.text}"


@dataclass(frozen=True)
class SourceFile:
    """One file.

    :param name: relative to the project
    :param is_test: whether it is one of the tests
    """

    name: str
    tree: ast.Module
    module: ModuleType
    is_test: bool

    @cached_property
    def nodes(self) -> list[ast.AST]:
        """All nodes of the tree, those of one level after those of the level above."""
        return list(ast.walk(self.tree))

    def all(self, kind: type[Node]) -> list[Node]:
        """Return all nodes of a kind."""
        return [each for each in self.nodes if isinstance(each, kind)]

    def at(self, node: ast.expr | ast.stmt) -> str:
        """Return the place of a node, such as ``robot.py:12``."""
        return f"{self.name}:{node.lineno}"

    def warning(self, node: ast.expr | ast.stmt, text: str, remedy: str) -> CodeWarning:
        """Return what is wrong with a node."""
        return CodeWarning(self.at(node), text, remedy)


def sources(project: Project) -> Iterator[SourceFile]:
    """Yield the robot's files and its tests; physics.py runs on no robot, and is left out."""
    for module in loaded_modules.look():
        file = str(module.__file__)
        if project.files.is_project_file(file) and Path(file) != project.physics_file:
            is_test = not project.files.is_robot_code(file)
            yield SourceFile(project.files.relative(file), parsed(file), module, is_test)


def methods_of(cls: ast.ClassDef) -> list[ast.FunctionDef]:
    """Return the methods that the body of a class defines."""
    return [each for each in cls.body if isinstance(each, ast.FunctionDef)]
