"""A test that all of your robot code has docstrings.

Docstrings make your code easier to maintain. To use this test, add ``from pyfrc.tests.docstring_test import *`` to a
file in your tests directory.
"""

from __future__ import annotations

import functools
import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from ..project.robot_files import RobotFiles

__all__ = ["ignore_object", "test_docstrings"]

#: ``:param speed:``, ``:param float speed:`` and ``:param *args:``
_PARAMETER = re.compile(r":param\s+(?:[^:\n]*\s)?(?:\\?\*)*(\w+)\s*:")


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
    """Check that all of your robot code has docstrings; ``physics.py`` does not run on the robot.

    That is each module, class, function, method and property, those whose names begin with ``_`` too. Inherited
    docstrings count. If a docstring describes parameters (``:param speed:``), it describes each of them once.
    """
    __tracebackhide__ = True
    found: set[tuple[str, int, str]] = set()
    for module in list(sys.modules.values()):
        if not isinstance(module, ModuleType) or getattr(module, "__file__", None) is None:
            continue
        if module.__name__ != "physics" and not ignore_object(module, robot_path):
            if not module.__doc__:
                found.add((*_place(module), f"{module.__name__} has no docstring"))
            found |= set(_mistakes(module, module.__name__, "", robot_path, set()))
    root = Path(robot_path).resolve()
    lines = [f"{Path(file).relative_to(root).as_posix()}:{line}: {mistake}" for file, line, mistake in sorted(found)]
    if lines:
        raise AssertionError("\n".join(["docstrings are missing or wrong:", *lines]))


def _mistakes(owner: Any, module: str, prefix: str, robot_path: str, seen: set[int]) -> Iterator[tuple[str, int, str]]:
    """Yield file, line and mistake of each class and function in a module or class.

    :param module: the name of the module; what it imports from others is not looked at
    :param seen: objects that have been looked at, under another name perhaps
    """
    for name, value in list(vars(owner).items()):
        function = _function(value)
        code = value if inspect.isclass(value) else function
        if code is None or id(code) in seen or code.__module__ != module or ignore_object(code, robot_path):
            continue
        seen.add(id(code))
        if code.__name__ in ("<lambda>", "__annotate__"):  # Python 3.14 makes one of a class's annotations
            continue
        # A property and its functions have one docstring, which may be inherited.
        documentation = code.__doc__ if inspect.isclass(value) else inspect.getdoc(value) or inspect.getdoc(code)
        if not documentation:
            yield *_place(code), f"{prefix}{name} has no docstring"
        if inspect.isclass(value):
            yield from _mistakes(value, module, f"{prefix}{name}.", robot_path, seen)
        else:
            is_bound = inspect.isclass(owner) and not isinstance(value, staticmethod)
            for mistake in _parameter_mistakes(code, is_bound):
                yield *_place(code), f"{prefix}{name} {mistake}"


def _function(value: Any) -> Any:
    """Return the function of a function, method or property; None for anything else."""
    if isinstance(value, property):
        value = value.fget
    elif isinstance(value, functools.cached_property):
        value = value.func
    elif isinstance(value, staticmethod | classmethod):
        value = value.__func__
    value = inspect.unwrap(value) if callable(value) and not inspect.isclass(value) else value
    return value if inspect.isfunction(value) else None


def _parameter_mistakes(function: Any, is_bound: bool) -> Iterator[str]:
    """Yield what is wrong with the parameters in a function's own docstring, if it has any."""
    documented = _PARAMETER.findall(function.__doc__ or "")
    parameters = list(inspect.signature(function).parameters)
    required = parameters[1:] if is_bound else parameters
    for name in dict.fromkeys(documented):
        if name not in parameters:
            yield f"documents {name}, which is no parameter"
        elif documented.count(name) > 1:
            yield f"documents {name} twice"
    if documented:
        yield from (f"does not document {name}" for name in required if name not in documented)


def _place(o: Any) -> tuple[str, int]:
    line = 1 if inspect.ismodule(o) else inspect.getsourcelines(o)[1]
    return str(Path(inspect.getsourcefile(o) or "?").resolve()), line
