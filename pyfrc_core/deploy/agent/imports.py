"""Modules and packages of the robot's Python. Nothing is imported, since that would take seconds and run code."""

from __future__ import annotations

import os
import pkgutil
import re
import sys
from collections.abc import Iterable
from importlib.machinery import EXTENSION_SUFFIXES, ModuleSpec, PathFinder
from typing import Any

_METADATA = (".dist-info", ".egg-info")


def look_up(modules: Iterable[str]) -> dict[str, Any]:
    """Return facts about this Python: missing modules, packages, suffixes of extension modules, machine.

    :param modules: dotted names to look for
    """
    if sys.platform == "win32":
        import platform

        machine = platform.machine()
    else:
        machine = os.uname().machine
    return {
        "missing_modules": [name for name in modules if not is_there(name)],
        "extension_suffixes": EXTENSION_SUFFIXES,
        "packages": installed_packages(),
        "machine": machine,
    }


def is_there(name: str) -> bool:
    """Return whether a module can be found; also True if only an import of its package could show this."""
    specification = _find(name.partition(".")[0])
    parts = name.split(".")
    for depth in range(2, len(parts) + 1):
        if specification is None or specification.submodule_search_locations is None:
            break  # the module may create its submodules at import, as `os` creates `os.path`
        below = specification.submodule_search_locations
        specification = _find_below(".".join(parts[:depth]), list(below))
    return specification is not None


def installed_packages() -> dict[str, str]:
    """Return the versions of installed distributions by normalized name."""
    found: dict[str, str] = {}
    for place in _path():
        try:
            names = sorted(each.name for each in os.scandir(place))
        except OSError:
            continue
        for each in names:
            if each.endswith(_METADATA):
                # From the names of directories: reading each of them takes a robot one second.
                name, _, version = each.rpartition(".")[0].partition("-")
                found.setdefault(re.sub(r"[-_.]+", "-", name).lower(), version.partition("-")[0])
    return found


def _path() -> list[str]:
    """Return `sys.path` without the agent's working directory, which is not on the robot program's path."""
    return [each for each in sys.path if each]


def _find(name: str) -> ModuleSpec | None:
    for finder in sys.meta_path:
        path = _path() if finder is PathFinder else None
        specification = finder.find_spec(name, path)
        if specification is not None:
            return specification
    return None


def _find_below(name: str, paths: list[str]) -> ModuleSpec | None:
    """Find a submodule in its package's directories. `importlib.util.find_spec` would import the package first."""
    portions: list[str] = []
    for place in paths:
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
