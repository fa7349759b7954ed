"""Methods of the user's whose parameters do not fit: `self` is missing, or a library passes other values."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from types import CodeType, FunctionType, ModuleType
from typing import Any

from ..errors import text_of
from ..project.robot_files import RobotFiles
from .explanation import Explanation
from .places import users_frame, users_functions

_DOCUMENTED = re.compile(r"\w+\(self(?:: [\w.]+)?(?P<parameters>.*?)\)(?: ->|$)", re.MULTILINE)
_PARAMETER = re.compile(r"[(,] (\w+):")


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if isinstance(error, (TypeError, AttributeError)) and (explained := _used_as_self(error, files)):
        return explained
    found = re.match(r"TypeError: (?:([\w.<>]+)\.)?(\S+?)\(\) (?:takes|missing|got)", text_of(error))
    if found is None:
        return None
    if (missing := re.search(r"missing .*: (.*)", str(error))) and found[2].startswith("test"):
        place = next((each for each in _places_of_test(found[1] or "", found[2], files)), "")
        text = f"the test does not get {missing[1]}: a unittest.TestCase passes no fixtures"
        remedy = f"Write class {found[1]}: without (unittest.TestCase), and assert for self.assertEqual"
        return Explanation(text, remedy, place) if place else None
    owner, method = _method(found[1], found[2], files)
    full = ".".join(filter(None, found.groups()))
    method = next((each for each in users_functions(error, files) if each.__qualname__ == full), method)
    if method is None:
        return None
    code, name = method.__code__, method.__name__
    place = f"{files.relative(code.co_filename)}:{code.co_firstlineno}"
    counts = re.search(r"takes (\d+) positional arguments? but (\d+) w", str(error))
    if counts and int(counts[2]) == int(counts[1]) + 1 and not _has_self(code):
        return Explanation(_without_self(code), place=place)
    if files.innermost_line(error.__traceback__, tests=False) is not None:
        return None  # the user's own code has called it
    passed = _passed(owner, name) if owner is not None else None
    if passed is None:
        return Explanation(place=place)
    text = f"{full}{inspect.signature(method)} has other parameters than the method that it replaces"
    return Explanation(text, f"Write def {name}({', '.join(['self', *passed])}):", place)


def _places_of_test(owner: str, name: str, files: RobotFiles) -> Iterator[str]:
    """Yield the place of a test that is a method."""
    for module in list(sys.modules.values()):
        code = getattr(getattr(getattr(module, owner, None), name, None), "__code__", None)
        if code is not None and files.is_project_file(code.co_filename):
            yield f"{files.relative(code.co_filename)}:{code.co_firstlineno}"


def _method(owner: str | None, name: str, files: RobotFiles) -> tuple[type[Any] | None, FunctionType | None]:
    """Return a class of the robot's code by its name, and its method."""
    for module in list(sys.modules.values()):
        cls = vars(module).get(owner or "") if isinstance(module, ModuleType) else None
        method = vars(cls).get(name) if isinstance(cls, type) else None
        if isinstance(method, FunctionType) and files.is_robot_code(method.__code__.co_filename):
            return cls, method
    return None, None


def _passed(cls: type[Any], name: str) -> list[str] | None:
    """Return the parameters, without `self`, of the library's method that a class overrides; None if there is none."""
    for base in cls.__mro__[1:]:
        method = vars(base).get(name)
        if isinstance(method, FunctionType):
            return list(inspect.signature(method).parameters)[1:]
        if method is not None:
            documented = _DOCUMENTED.search(str(method.__doc__))
            return _PARAMETER.findall(documented["parameters"]) if documented else []
    return None


def _used_as_self(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Explain a method whose first parameter, such as `control`, has got the object itself."""
    where = users_frame(error, files)
    if where is None:
        return None
    code = where[0].f_code
    first = where[0].f_locals.get(code.co_varnames[0]) if code.co_argcount and not _has_self(code) else None
    method = getattr(type(first), code.co_name, None)
    if getattr(method, "__code__", None) is not code or getattr(error, "obj", first) is not first:
        return None
    return Explanation(_without_self(code), place=f"{files.relative(code.co_filename)}:{code.co_firstlineno}")


def _has_self(code: CodeType) -> bool:
    return code.co_varnames[: code.co_argcount][:1] in {("self",), ("cls",), ("this",)}


def _without_self(code: CodeType) -> str:
    parameters = code.co_varnames[: code.co_argcount]
    written, corrected = ", ".join(parameters), ", ".join(["self", *parameters])
    return f"the method {code.co_name}({written}) has no parameter self: write def {code.co_name}({corrected}):"
