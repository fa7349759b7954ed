"""A test that all of your robot code has docstrings.

Docstrings make your code easier to maintain. To use this test, add ``from pyfrc.tests.docstring_test import *`` to a
file in your tests directory.
"""

from __future__ import annotations

import inspect
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from ..project.robot_files import RobotFiles

__all__ = ["ignore_object", "test_docstrings"]


def ignore_object(o: Any, robot_path: str) -> bool:
    """Return whether the object is not part of the robot's own code.

    :param o: a module, class or function
    :param robot_path: the directory of the robot's code
    """
    try:
        source = inspect.getsourcefile(inspect.unwrap(o))
    except (TypeError, ValueError):
        return True
    if source is None:
        return True
    return not RobotFiles(Path(robot_path).resolve()).is_robot_code(str(Path(source).resolve()))


def test_docstrings(robot: Any, robot_path: str) -> None:
    """Check that all of your robot code has docstrings; ``physics.py`` does not run on the robot."""
    __tracebackhide__ = True
    missing = [
        place
        for module in list(sys.modules.values())
        if isinstance(module, ModuleType) and module.__name__ != "physics" and not ignore_object(module, robot_path)
        for place in _without_docstring(module, robot_path)
    ]
    missing.sort(key=_file_and_line)
    assert not missing, "these have no docstring:\n" + "\n".join(missing)


def _file_and_line(place: str) -> tuple[str, int]:
    file, _, line = place.rpartition(": ")[0].rpartition(":")
    return file, int(line)


def _without_docstring(module: ModuleType, robot_path: str) -> list[str]:
    found = [] if module.__doc__ else [_place(module, module.__name__, robot_path)]
    for name, value in vars(module).items():
        if not (inspect.isclass(value) or inspect.isfunction(value)) or value.__module__ != module.__name__:
            continue
        if ignore_object(value, robot_path):
            continue
        if not value.__doc__:
            found.append(_place(value, name, robot_path))
        if inspect.isclass(value):
            found += [
                _place(method, f"{name}.{method_name}", robot_path)
                for method_name, method in vars(value).items()
                if inspect.isfunction(method) and not method_name.startswith("_") and not inspect.getdoc(method)
            ]
    return found


def _place(o: Any, name: str, robot_path: str) -> str:
    source = Path(inspect.getsourcefile(o) or "?").resolve()
    line = 1 if inspect.ismodule(o) else inspect.getsourcelines(o)[1]
    return f"{source.relative_to(Path(robot_path).resolve())}:{line}: {name}"
