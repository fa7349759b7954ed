"""Choose the robot class of an imported main file, or explain why there is not exactly one."""

from __future__ import annotations

import ast
from pathlib import Path
from types import ModuleType
from typing import Any

from ..errors import ProjectError
from ..project import Project
from ..wpi import names


def choose_robot_class(project: Project, module: ModuleType) -> type[Any]:
    """Return the robot class of the project's main file.

    :param module: the main file, imported
    :raises ProjectError: when there is not exactly one robot class to choose
    """
    from ..wpi import robots as kinds  # only where a robot has been imported: WPILib may be missing or broken

    where = project.main_file.name
    robots = {value.__name__: value for value in vars(module).values() if kinds.is_robot_class(value)}
    here = {name: robot for name, robot in robots.items() if robot.__module__ == module.__name__}
    # A robot class kept in another file of the project and imported here counts when there is none here.
    robots = here or robots
    wanted = project.class_name or project.settings.robot_class
    if wanted is not None:
        if wanted not in robots:
            known = ", ".join(sorted(robots)) or "none"
            raise ProjectError(f"there is no robot class {wanted!r}", where=where, remedy=f"There is: {known}.")
        return robots[wanted]
    # A class that others here derive from is their base, not a robot of its own.
    bases = {base for robot in robots.values() for base in robot.__mro__[1:]}
    candidates = [robot for robot in robots.values() if robot not in bases]
    if not candidates:
        raise _no_robot_class(project, module)
    if len(candidates) > 1:
        lines = ", ".join(
            f"{robot.__name__} ({where}:{_line_of_class(project.main_file, robot.__name__)})" for robot in candidates
        )
        raise ProjectError(
            f"there are {len(candidates)} robot classes: {lines}",
            where=where,
            remedy=f"Choose one with --robot-class {candidates[0].__name__}, "
            f'or with robot_class = "{candidates[0].__name__}" under [tool.pyfrc] in pyproject.toml.',
        )
    return candidates[0]


def _no_robot_class(project: Project, module: ModuleType) -> ProjectError:
    where = project.main_file.name
    if (alike := _without_base(module)) is not None:
        return ProjectError(
            f"the class {alike} is not derived from a robot class",
            where=f"{where}:{_line_of_class(project.main_file, alike)}",
            remedy=f"Write: class {alike}(wpilib.TimedRobot):",
        )
    return ProjectError(
        "there is no robot class in this file",
        where=where,
        remedy="Define one, such as: class MyRobot(wpilib.TimedRobot). "
        "If it is in another file, name that with --main FILE.",
    )


def _without_base(module: ModuleType) -> str | None:
    """Return the name of a class that has a robot's methods but no base class that would call them."""
    for value in vars(module).values():
        own = isinstance(value, type) and value.__module__ == module.__name__ and value.__bases__ == (object,)
        if own and names.OF_A_ROBOT.intersection(vars(value)):
            return str(value.__name__)
    return None


def _line_of_class(file: Path, name: str) -> int:
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.ClassDef) and node.name == name:
            return node.lineno
    return 1
