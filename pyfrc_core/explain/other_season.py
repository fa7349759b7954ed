"""Names of another season, from the table that `pyfrc migrate` has: of 2026 beside WPILib 2027, of 2027 beside WPILib
2026, and of the seasons before.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..config.robotpy import load_season_settings
from ..errors import SettingsError
from ..project.robot_files import RobotFiles
from ..season import CURRENT, SEASONS
from ..season.names.table import Member, earlier_names, table
from ..season.spelling import snake_case
from .explanation import Explanation
from .places import imported_name

#: Modules and names that 2027 has, and 2026 has not.
_MODULES_OF_2027 = frozenset({"telemetry", "tunables", "wpilib_drivers", "wpilog"})
_NAMES_OF_2027 = frozenset(
    {
        *("CANPort", "DriverStationBackend", "EdgeCounter", "ExpansionHub", "Gamepad", "MatchState", "OnboardIMU"),
        *("OpMode", "OpModeRobot", "OpModeRobotBase", "PeriodicOpMode", "Tachometer"),
        *("autonomous", "teleop", "utility"),
    }
)
#: Words in a remedy that may be names: with dots, or with a capital letter inside.
_NAME = re.compile(r"\b[a-z]\w*(?:\.\w+)+|\b[a-z]{2,}\d?(?:[A-Z][A-Za-z0-9]*)+\b")


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    if isinstance(error, ModuleNotFoundError):
        return _module(error.name or "", files)
    if isinstance(error, ImportError):
        return _of_module(imported_name(error), error.name or "", files)
    if isinstance(error, AttributeError) and error.name:
        owner = error.obj if isinstance(error.obj, type) else type(error.obj)
        if owner.__module__ == "builtins":
            return _of_module(error.name, str(getattr(error.obj, "__name__", "")), files)
        base = next((each for each in owner.__mro__ if _is_library(each.__module__)), None)
        if base is not None and (instead := _of_class(error.name, base)):
            return _explanation(2026, f"{owner.__name__} has no {error.name}", files, f"Instead: {instead}.")
    return None


def earlier_name(name: str, owner: type) -> str:
    """Return what replaces a name of the seasons before 2026 in a class; empty if none is known."""
    names = earlier_names()
    keys = [f"{base.__name__}.{name}" for base in owner.__mro__] + [name]
    instead = next((names[key] for key in keys if key in names), "")
    return _of_class(instead, owner) or in_2027(instead)


def in_2027(text: str) -> str:
    """Return a remedy that is written in 2026's names, in those of the installed WPILib."""
    return text if CURRENT.year < 2027 else _NAME.sub(lambda found: _today(found[0]), text)


def _today(path: str) -> str:
    """Return the name in 2027 of a name of 2026, or of a member of a class: ``wpimath.Rotation2d.from_degrees``."""
    names, parts = table(), path.split(".")
    for end in range(len(parts), 0, -1):
        known = ".".join(parts[:end])
        if known not in names.modules and names.name(known) is None:
            continue
        new, rest = names.new_path(known) or known, parts[end:]
        member = names.member(known, rest[0]) if rest else None
        if member is not None and member[1].new is not None:
            first, rest = member[1].new, rest[1:]
            new = first if "." in first else f"{new}.{first}"
        return ".".join([new, *map(snake_case, rest)])
    return ".".join(map(snake_case, parts))


def _of_class(name: str, cls: type) -> str:
    """Return what replaces a name of a class of 2026, or one that is only half of 2027; empty if none is known."""
    if CURRENT.year < 2027:
        return ""
    for member in _members_before(cls):
        new = member.new or ""
        if name in (member.name, snake_case(member.name)) and ("." in new or hasattr(cls, new)):
            return new
    return _respelled(name, dir(cls))


def _members_before(cls: type) -> Iterator[Member]:
    """Yield the members, and the classes inside, that a class had in 2026."""
    names = table()
    for base in cls.__mro__:
        for old in names.before(base.__name__):
            yield from (found[1] for each in names.member_names(old) if (found := names.member(old, each)))
            yield from (Member(path.rpartition(".")[2], new) for path, new in names.inside(old))


def _module(module: str, files: RobotFiles) -> Explanation | None:
    text, names = f"there is no module {module}", table()
    if CURRENT.year < 2027:
        return _explanation(2027, text, files) if module.partition(".")[0] in _MODULES_OF_2027 else None
    new = names.modules.get(module, module)
    return None if new == module else _explanation(2026, text, files, _instead(new, names.advice(module)))


def _of_module(name: str, module: str, files: RobotFiles) -> Explanation | None:
    text, path, names = f"{module} has no {name}", f"{module}.{name}", table()
    if not _is_library(module):
        return None
    if CURRENT.year < 2027:
        return _explanation(2027, text, files) if name in _NAMES_OF_2027 else None
    if names.modules.get(path, path) != path:
        return _module(path, files)
    if names.name(path) is None:
        known = _respelled(name, dir(sys.modules.get(module)))
        return _explanation(2026, text, files, _instead(known, "")) if known else None
    return _explanation(2026, text, files, _instead(names.new_path(path), names.advice(path)))


def _respelled(name: str, known: Iterable[str]) -> str:
    """Return the name of 2027 that has the same letters as one of 2026; of ``kRed``, those of ``RED``."""

    def letters(each: str) -> str:
        return re.sub(r"^k(?=[A-Z])", "", each).replace("_", "").lower()

    return next((each for each in known if letters(each) == letters(name) and not each.startswith("_")), "")


def _instead(new: str | None, advice: str) -> str:
    return f"Instead: {new}." if new else advice


def _is_library(module: str) -> bool:
    top = module.partition(".")[0]
    return top in _MODULES_OF_2027 or top in table().modules


def _explanation(year: int, text: str, files: RobotFiles, instead: str = "") -> Explanation:
    """Return the explanation of a name of another season.

    Where the project does not say its season, it may be the WPILib that is wrong: the remedy has both.

    :param instead: what to write in this season
    """
    remedy = [instead] if instead else []
    try:
        says = load_season_settings(Path(files.root) / "pyproject.toml")
    except (SettingsError, OSError):
        says = []  # reported where the settings are needed
    if not says or not instead:
        wanted = f'pip install "{SEASONS[year].requirement}"' if year in SEASONS else "install the pyfrc of that season"
        remedy.append(f"If the robot is for WPILib {year}: {wanted}")
    return Explanation(f"{text} in WPILib {CURRENT.year}", "\n  ".join(remedy))
