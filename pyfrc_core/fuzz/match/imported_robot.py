"""The robot's code in this process: imported once, and what fuzz learns from it."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterable
from contextlib import suppress
from functools import lru_cache
from typing import Any

from ...hal import devices_exist
from ...invariants.load import Invariant, load_invariants
from ...project import Project
from ...runtime.loading import load_robot
from ...runtime.patches.install import patches
from ...runtime.threads.fork_obstacles import library_threads, reasons_not_to_fork
from ..guidance.lines import RobotLines
from ..inputs.robot_constants import find_constants
from ..inputs.values import RobotConstants


@lru_cache(maxsize=1)
def robot_lines(project: Project) -> RobotLines:
    """Return the lines of the robot, which the first call imports."""
    load(project)
    return RobotLines(project.files)


@lru_cache(maxsize=1)
def robot_constants(project: Project) -> RobotConstants:
    """Return the constants of the robot's code."""
    return find_constants(robot_lines(project).functions)


@lru_cache(maxsize=1)
def load(project: Project) -> type[Any]:
    """Import the robot program, its physics and its rules, with the first call; return the robot class.

    :raises RobotCodeError: when its code fails
    :raises InvariantError: when a rule cannot be called
    """
    patches.install(project.files)
    robot_class = load_robot(project)
    if project.physics_file.is_file():
        from ...physics.engine import load_physics

        load_physics(project)
    invariants_of(project)
    return robot_class


def libraries_of(project: Project) -> tuple[str, ...]:
    """Return the names of the modules that importing the robot imports, and that are not the project's own, in order.

    The robot must not have been imported in this process.
    """
    from ...runtime.pristine.modules import ProjectModules

    modules, before = ProjectModules(project.files), set(sys.modules)
    load(project)
    new = [(name, module) for name, module in list(sys.modules.items()) if name not in before]
    return tuple(name for name, module in new if not modules.is_of_project(module))


def import_libraries(project: Project, libraries: Iterable[str]) -> bool:
    """Import these modules, as the robot would; return whether this process can still be forked."""
    patches.install(project.files)
    library_threads.begin()
    for name in libraries:
        with suppress(Exception):  # the robot's import shows it, if it needs this one
            importlib.import_module(name)
    return not reasons_not_to_fork()


@lru_cache(maxsize=1)
def invariants_of(project: Project) -> tuple[Invariant, ...]:
    """Return the project's rules, which the first call imports."""
    return load_invariants(project)


@lru_cache(maxsize=1)
def imported_devices(project: Project) -> bool:
    """Return whether importing the robot has created devices in the HAL.

    The first call must come before a robot runs in this process.
    """
    load(project)
    return devices_exist()


def forget() -> None:
    """Forget the robot, which is to be imported again."""
    for known in (robot_lines, robot_constants, load, invariants_of, imported_devices):
        known.cache_clear()
