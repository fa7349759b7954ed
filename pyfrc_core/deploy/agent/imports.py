"""Modules and packages of the robot's Python. Nothing is imported, since that would take seconds and run code."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable
from importlib.machinery import PathFinder
from typing import Any

_METADATA = (".dist-info", ".egg-info")


def look_up(modules: Iterable[str]) -> dict[str, Any]:
    """Return facts about this Python: missing modules, packages, machine.

    :param modules: top-level modules to look for
    """
    if sys.platform == "win32":
        import platform

        machine = platform.machine()
    else:
        machine = os.uname().machine
    return {
        "missing_modules": [name for name in modules if not is_there(name)],
        "packages": installed_packages(),
        "machine": machine,
    }


def is_there(module: str) -> bool:
    """Return whether a top-level module can be found."""
    return any(finder.find_spec(module, _path() if finder is PathFinder else None) for finder in sys.meta_path)


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
