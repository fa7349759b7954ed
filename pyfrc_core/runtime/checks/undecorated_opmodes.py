"""Find opmodes that WPILib never publishes, since nothing says for which mode they are: there is no error."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ...project.loaded_modules import loaded_modules
from ...season import CURRENT
from .code_warning import CodeWarning

if TYPE_CHECKING:
    from ...project import Project

_BASES = ("OpMode", "PeriodicOpMode")


def find_undecorated_opmodes(project: Project) -> list[CodeWarning]:
    """Return the classes of opmodes without a decorator that no other line of the project names."""
    if not CURRENT.opmodes:
        return []
    files = {Path(str(module.__file__)) for module in loaded_modules.look()}
    files = {file for file in files if project.files.is_robot_code(str(file))}
    files |= set((project.main_file.parent / "opmodes").rglob("*.py"))  # not imported if nothing in them is decorated
    texts = {file: file.read_text("utf-8", "replace") for file in sorted(files)}
    return [
        CodeWarning(
            f"{project.files.relative(str(file))}:{line}",
            f"WPILib never runs {name}: nothing says which mode this opmode is for",
            "Write @wpilib.autonomous, @wpilib.teleop or @wpilib.utility above the class.",
        )
        for file, text in texts.items()
        for name, line in _undecorated(text)
        if not any(re.search(rf"(?<!class )\b{name}\b", other) for other in texts.values())
    ]


def _undecorated(text: str) -> Iterator[tuple[str, int]]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError):  # reported when it is imported
        return
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and not node.decorator_list:
            bases = [each.attr if isinstance(each, ast.Attribute) else getattr(each, "id", "") for each in node.bases]
            if any(base in _BASES for base in bases):
                yield node.name, node.lineno
