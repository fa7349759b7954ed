"""Which modules and packages the robot's Python has. Nothing is imported: that would take seconds, and run code."""

from __future__ import annotations

import os
import pkgutil
import platform
import re
import sys
from collections.abc import Iterable
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec, PathFinder
from typing import Any

_METADATA = (".dist-info", ".egg-info")


def look_up(modules: Iterable[str]) -> dict[str, Any]:
    """Describe this Python to the laptop.

    :param modules: dotted names; the result has those of them that cannot be found
    """
    return {
        "missing_modules": [name for name in modules if not is_there(name)],
        "extension_suffixes": EXTENSION_SUFFIXES,
        "packages": installed_packages(),
        "machine": platform.machine(),
    }


def is_there(name: str) -> bool:
    """Return whether a module can be found; true where only importing its package could tell."""
    specification = _find(name.partition(".")[0])
    parts = name.split(".")
    for depth in range(2, len(parts) + 1):
        if specification is None or specification.submodule_search_locations is None:
            break  # the module may make its submodules itself, as `os` makes `os.path`
        below = specification.submodule_search_locations
        specification = _find_below(".".join(parts[:depth]), list(below))
    return specification is not None


def installed_packages() -> dict[str, str]:
    """Return the versions of the installed distributions by their normalized names."""
    found: dict[str, str] = {}
    for place in _path():
        try:
            names = sorted(each.name for each in os.scandir(place))
        except OSError:
            continue
        for each in names:
            if each.endswith(_METADATA):
                # By the names of directories: opening each of them takes a robot a second.
                name, _, version = each.rpartition(".")[0].partition("-")
                found.setdefault(re.sub(r"[-_.]+", "-", name).lower(), version.partition("-")[0])
    return found


def _path() -> list[str]:
    """Where the robot program finds modules besides its own: not in the directory that the agent was started in."""
    return [each for each in sys.path if each]


def _find(name: str) -> ModuleSpec | None:
    for finder in sys.meta_path:
        path = _path() if finder is PathFinder else None
        specification = finder.find_spec(name, path)
        if specification is not None:
            return specification
    return None


def _find_below(name: str, places: list[str]) -> ModuleSpec | None:
    """Find a submodule by its package's directories. The import system's own way would import the package first."""
    portions: list[str] = []
    for place in places:
        finder = pkgutil.get_importer(place)
        specification = None if finder is None else finder.find_spec(name, None)
        if specification is None:
            continue
        if specification.loader is not None:
            return specification
        portions += specification.submodule_search_locations or ()
    if not portions:
        return None
    namespace = ModuleSpec(name, None, is_package=True)
    namespace.submodule_search_locations = portions
    return namespace
