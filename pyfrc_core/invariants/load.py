"""Find and import the rules of a project."""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, ModuleType

from ..errors import UsageError, nearest
from ..project import Project
from ..project.loaded_modules import loaded_modules
from ..runtime.loading import import_file
from .decorator import MARK

#: What a rule may have as parameters.
PARAMETERS = ("hal_data", "robot")


class InvariantError(UsageError):
    """A function with the decorator `pyfrc.invariant` cannot be a rule."""


@dataclass(frozen=True)
class Invariant:
    """A rule.

    :param function: returns False, or raises `AssertionError`, if the rule is broken
    :param parameters: those of `PARAMETERS` that the function has
    :param place: where it is defined, such as ``tests/rules.py:5``
    """

    function: Callable[..., object]
    parameters: tuple[str, ...]
    place: str

    @property
    def name(self) -> str:
        return self.code.co_name

    @property
    def code(self) -> CodeType:
        return _code_of(self.function)


def load_invariants(project: Project) -> tuple[Invariant, ...]:
    """Import the project's files with rules, and return the rules in the order of their files and lines.

    The robot's own code must have been imported before.

    :raises InvariantError: when a function cannot be a rule
    :raises RobotCodeError: when the import of a file fails
    """
    return tuple(rule for file in project.invariant_files for rule in _rules_in(project, file))


def _rules_in(project: Project, file: Path) -> Iterator[Invariant]:
    module = _loaded(file) or _import(project, file)
    marked = {id(each): each for each in vars(module).values() if _is_rule(each)}
    functions = [each for each in marked.values() if Path(_code_of(each).co_filename).samefile(file)]
    for function in sorted(functions, key=lambda each: _code_of(each).co_firstlineno):
        place = f"{project.files.relative(str(file))}:{_line_of(function)}"
        yield Invariant(function, _parameters(function, place), place)


def _is_rule(value: object) -> bool:
    return inspect.isfunction(value) and MARK in vars(value)


def _code_of(function: Callable[..., object]) -> CodeType:
    code: CodeType = inspect.unwrap(function).__code__
    return code


def _line_of(function: Callable[..., object]) -> int:
    """Return the line of ``def``; before it there are decorators, which Python counts to the function."""
    lines, first = inspect.getsourcelines(inspect.unwrap(function))
    heads = (number for number, line in enumerate(lines) if line.lstrip().startswith(("def ", "async def ")))
    return first + next(heads, 0)


def _parameters(function: Callable[..., object], place: str) -> tuple[str, ...]:
    """Return the parameters to pass.

    :raises InvariantError: when the rule has other parameters, or cannot be called in one go
    """
    name = _code_of(function).co_name
    if inspect.iscoroutinefunction(function) or inspect.isgeneratorfunction(function):
        raise InvariantError(f"the rule {name}() must be a plain function: without async and yield", where=place)
    found = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.name in PARAMETERS and parameter.kind is parameter.POSITIONAL_OR_KEYWORD:
            found.append(parameter.name)
        elif parameter.default is parameter.empty:
            raise InvariantError(
                f"the rule {name}() has the parameter {str(parameter).partition(':')[0]!r}",
                where=place,
                remedy=f"A rule can have the parameters hal_data and robot: {nearest(parameter.name, [*PARAMETERS])}",
            )
    return tuple(found)


def _loaded(file: Path) -> ModuleType | None:
    """Return the module of this file if it is imported, as pytest does with test files."""
    for module in loaded_modules.look():
        origin = str(module.__file__)
        if origin.endswith(file.name) and os.path.realpath(origin) == os.path.realpath(file):
            return module
    return None


def _import(project: Project, file: Path) -> ModuleType:
    """Import a file under the name that pytest would use, with its packages, and with its neighbors importable."""
    directory, packages = file.parent, list[Path]()
    while (directory / "__init__.py").is_file():
        packages.insert(0, directory)
        directory = directory.parent
    names = [package.name for package in packages]
    for number, package in enumerate(packages):
        if _loaded(package / "__init__.py") is None:
            import_file(project, package / "__init__.py", ".".join(names[: number + 1]))
    if str(directory) not in sys.path:
        sys.path.insert(1, str(directory))  # after the robot's own directory
    name = ".".join([*names, file.stem])
    if name in sys.modules:  # the robot has a module of this name
        name = f"{file.stem} (invariants)"
    return import_file(project, file, name)
