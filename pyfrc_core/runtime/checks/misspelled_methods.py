"""Find methods that WPILib never calls because of a misspelled name, such as ``teleopPeriodc``, or wrong indentation.

WPILib calls the base class's empty method instead, so the robot silently does nothing. A method is reported only if its
name resembles an overridable method of the base class that the class does not override, and if nothing in the project
refers to it; a function inside another method, only if it has such a name and a parameter ``self``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from inspect import isasyncgenfunction, iscoroutinefunction, isgeneratorfunction
from pathlib import Path
from types import CodeType, FunctionType

from ...errors import RobotCodeError
from ...project import Project
from ...project.loaded_modules import loaded_modules
from ...wpi import names
from .sources import CodeWarning


def find_misspelled_methods(project: Project) -> list[CodeWarning]:
    """Return the misspelled methods in the project's imported modules, sorted by line."""
    found = [each for cls in robot_classes(project) for each in _in_class(cls, project)]
    return sorted(set(found), key=lambda each: (each.where.rpartition(":")[0], int(each.where.rpartition(":")[2])))


def refuse_unawaited_methods(project: Project) -> None:
    """Check the methods that WPILib calls: one with ``async`` or ``yield`` returns at once, and nothing in it runs.

    :raises RobotCodeError: when there is such a method, with its line
    """
    for cls in robot_classes(project):
        if not any(base.__module__.partition(".")[0] in names.LIBRARIES for base in cls.__mro__):
            continue
        for name, method in vars(cls).items():
            if not isinstance(method, FunctionType) or not _is_called(name):
                continue
            is_async = iscoroutinefunction(method) or isasyncgenfunction(method)
            if is_async or isgeneratorfunction(method):
                word, instead = ("async", f"def {name}(self):") if is_async else ("yield", "it without yield")
                raise RobotCodeError(
                    f"{cls.__name__}.{name} never runs: WPILib calls it, but does not wait for a method with {word}",
                    where=_place(method.__code__, project),
                    remedy=f"Write {instead}{' without async and await' if is_async else ''}. Do what takes longer "
                    "than one loop in small steps, one each time that the method is called.",
                )


def robot_classes(project: Project) -> Iterator[type]:
    """Yield the classes of the project's imported modules."""
    for module in loaded_modules.look():
        if not project.files.is_robot_code(str(module.__file__)):
            continue
        for value in list(vars(module).values()):
            if isinstance(value, type) and value.__module__ == module.__name__:
                yield value


def _is_called(name: str) -> bool:
    """Return whether a library calls a method of this name, which a class overrides."""
    return name in names.OVERRIDDEN or name in names.OF_MODES


def _in_class(cls: type, project: Project) -> Iterator[CodeWarning]:
    library = [base for base in cls.__mro__ if base.__module__.partition(".")[0] in names.LIBRARIES]
    if not library:
        return
    known = {name for base in library for name in vars(base)}
    own = {name for base in cls.__mro__ if base not in library and base is not object for name in vars(base)}
    missing = {name for name in known if _is_called(name)} - own
    not_called = {name: place for base in library for name, place in names.NOT_CALLED.get(base.__name__, {}).items()}
    is_opmode = any(base.__name__ == "OpMode" for base in library)
    for name, method in list(vars(cls).items()):
        if not isinstance(method, FunctionType) or not project.files.is_robot_code(method.__code__.co_filename):
            continue
        for code in _inside(method, missing):
            yield CodeWarning(
                _place(code, project),
                f"WPILib never calls {code.co_name}, which is inside {cls.__name__}.{name}",
                f"Indent it as much as {name}.",
            )
        if name in known or name.startswith("__"):
            continue
        if (instead := not_called.get(_plain(name))) is not None and not _is_referred_to(name, project):
            where = _place(method.__code__, project)
            yield CodeWarning(where, f"WPILib does not call {cls.__name__}.{name}", f"Move its lines to {instead}.")
            continue
        meant = _nearest(name, missing, in_short_names=1 if is_opmode else 0)
        if meant is not None and not _is_referred_to(name, project):
            spelling, whose = names.OTHER_SPELLING
            season = f" ({whose})" if spelling.search(name) else ""
            yield CodeWarning(
                _place(method.__code__, project),
                f"WPILib never calls {cls.__name__}.{name}: did you mean {meant}?{season}",
                f"Rename it to {meant}.",
            )


def _inside(method: FunctionType, missing: set[str]) -> Iterator[CodeType]:
    """Yield the functions inside a method that were probably meant to be methods of a mode."""
    for code in method.__code__.co_consts:
        if not isinstance(code, CodeType) or code.co_varnames[: code.co_argcount] != ("self",):
            continue
        if code.co_name in missing and code.co_name in names.OF_MODES:
            yield code


def _place(code: CodeType, project: Project) -> str:
    return f"{project.files.relative(code.co_filename)}:{code.co_firstlineno}"


def _nearest(name: str, known: set[str], in_short_names: int) -> str | None:
    """Return the most probable correct name, if there is one.

    :param in_short_names: how many mistakes a name of a few letters, such as ``end``, may have
    """
    plain = _plain(name)
    allowed = {each: 2 if len(each) >= 12 else 1 if len(each) >= 7 else in_short_names for each in known}
    distances = {each: _distance(plain, each.replace("_", "").lower()) for each in known}
    close = [each for each in sorted(known) if distances[each] <= allowed[each]]
    return min(close, key=distances.__getitem__, default=None)


def _plain(name: str) -> str:
    """Return the name in a normal form: ``teleop_periodic`` and ``TeleopPeriodic`` are the same."""
    plain = name.replace("_", "").lower()
    for synonym, word in names.SYNONYMS:
        plain = synonym.sub(word, plain)
    return plain


def _distance(one: str, other: str) -> int:
    """Return the edit distance: insertions, deletions, replacements, swaps; 3 if the lengths differ by more than 2."""
    if abs(len(one) - len(other)) > 2:
        return 3
    before: list[int] = []
    row = list(range(len(other) + 1))
    for i, letter in enumerate(one, 1):
        before, last, row = row, before, [i]
        for j, wanted in enumerate(other, 1):
            cost = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != wanted))
            if i > 1 and j > 1 and letter == other[j - 2] and one[i - 2] == wanted:
                cost = min(cost, last[j - 2] + 1)
            row.append(cost)
    return row[-1]


def _is_referred_to(name: str, project: Project) -> bool:
    """Return whether the project uses this name anywhere besides its definition."""
    reference = re.compile(rf"(?<!def )(?<!super\(\)\.)\b{re.escape(name)}\b")
    for module in loaded_modules.look():
        file = str(module.__file__)
        if project.files.is_robot_code(file):
            lines = Path(file).read_text("utf-8", "replace").splitlines()
            if any(reference.search(line.partition("#")[0]) for line in lines):
                return True
    return False
