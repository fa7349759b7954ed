"""The project's imported files, as syntax trees, for the checks that read code."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...explain.places import parsed
from ...project.loaded_modules import loaded_modules

if TYPE_CHECKING:
    from types import ModuleType

    from ...project import Project


@dataclass(frozen=True)
class Source:
    """One file.

    :param name: relative to the project
    :param is_test: whether it is one of the tests
    """

    name: str
    tree: ast.Module
    module: ModuleType
    is_test: bool

    def at(self, node: ast.expr | ast.stmt) -> str:
        """Return the place of a node, such as ``robot.py:12``."""
        return f"{self.name}:{node.lineno}"


def sources(project: Project) -> Iterator[Source]:
    """Yield the robot's files and its tests; physics.py runs on no robot, and is left out."""
    for module in loaded_modules.look():
        file = str(module.__file__)
        if project.files.is_project_file(file) and Path(file) != project.physics_file:
            is_test = not project.files.is_robot_code(file)
            yield Source(project.files.relative(file), parsed(file), module, is_test)
