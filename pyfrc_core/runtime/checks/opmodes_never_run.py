"""Find opmodes that WPILib never runs, without an error: nothing says which mode they are for, or two have one name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from ...project import Project
from ...project.loaded_modules import loaded_modules
from ...project.walk import python_files, text_to_search
from ...season import CURRENT
from ...wpi.opmodes import DECORATORS
from .sources import CodeWarning

_BASES = ("OpMode", "PeriodicOpMode")


def find_opmodes_never_run(project: Project) -> list[CodeWarning]:
    """Return the opmodes without a decorator that no other line names, and those whose name another one has."""
    if not CURRENT.opmodes:
        return []
    files = {Path(str(module.__file__)) for module in loaded_modules.look()}
    files = {file for file in files if project.files.is_robot_code(str(file))}
    files |= set(python_files(project.main_file.parent / "opmodes"))  # not imported if nothing in them is decorated
    texts = {file: text_to_search(file) for file in sorted(files)}
    found: list[CodeWarning] = []
    places: dict[tuple[str, str], str] = {}
    for file, text in texts.items():
        for node in _classes(text):
            place = f"{project.files.relative(str(file))}:{node.lineno}"
            if not node.decorator_list:
                if any(_name(base) in _BASES for base in node.bases) and not any(
                    re.search(rf"(?<!class )\b{node.name}\b", other) for other in texts.values()
                ):
                    message = f"WPILib never runs {node.name}: nothing says which mode this opmode is for"
                    remedy = "Write @wpilib.autonomous, @wpilib.teleop or @wpilib.utility above the class."
                    found.append(CodeWarning(place, message, remedy))
                continue
            for mode, name in _published(node):
                if (other := places.setdefault((mode, name), place)) != place:
                    message = f"WPILib runs only one of the opmodes {name!r} for {mode}: another one is at {other}"
                    found.append(CodeWarning(place, message, f"Give them different names: @wpilib.{mode}(name=...)."))
    return found


def _classes(text: str) -> list[ast.ClassDef]:
    try:
        return [node for node in ast.parse(text).body if isinstance(node, ast.ClassDef)]
    except (SyntaxError, ValueError):  # reported when it is imported
        return []


def _published(node: ast.ClassDef) -> Iterator[tuple[str, str]]:
    """Yield mode and name of a decorated class, if its name is not computed."""
    for decorator in node.decorator_list:
        mode = _name(decorator.func if isinstance(decorator, ast.Call) else decorator)
        if mode in DECORATORS:
            keywords = decorator.keywords if isinstance(decorator, ast.Call) else []
            name = next((each.value for each in keywords if each.arg == "name"), ast.Constant(node.name))
            if isinstance(name, ast.Constant):
                yield mode, str(name.value or node.name)


def _name(node: ast.expr) -> str:
    return node.attr if isinstance(node, ast.Attribute) else str(getattr(node, "id", ""))
