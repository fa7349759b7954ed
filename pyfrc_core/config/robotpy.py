"""``[tool.robotpy]`` in pyproject.toml: the packages that a project needs on its robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import SettingsError, nearest
from ..season import SEASONS, SeasonSetting, year_of
from .toml_file import TomlFile

if TYPE_CHECKING:
    from packaging.requirements import Requirement

#: The packages that the optional components install on a robot; the others are for desktops only.
COMPONENTS: dict[str, tuple[str, ...]] = {
    "apriltag": ("robotpy-apriltag",),
    "commands2": ("robotpy-commands-v2",),
    "cscore": ("robotpy-cscore",),
}
COMPONENTS["all"] = tuple(package for packages in COMPONENTS.values() for package in packages)

#: How the names of packages begin whose versions begin with a season's year.
NUMBERED_BY_SEASON = ("wpilib", "robotpy", "pyntcore")

#: The ``robotpy_version`` with which the season's tools since 2027 install only `requires`.
_IGNORED = "ignored"

#: Components that install nothing on a robot.
_ON_DESKTOPS = ("romi", "sim", "xrp")


@dataclass(frozen=True)
class RobotPackages:
    """The packages that a project needs on its robot.

    :param version:    of WPILib; none: any
    :param components: the names of optional components
    :param requires:   further packages
    :param lines:      where in pyproject.toml each key is, as ``pyproject.toml:3``
    :param only_requires: whether the robot gets only `requires`, and no WPILib: ``robotpy_version = "ignored"``
    """

    version: str | None
    components: tuple[str, ...]
    requires: tuple[Requirement, ...]
    lines: dict[str, str]
    only_requires: bool = False


def load_robot_packages(pyproject: Path) -> RobotPackages:
    """Return what ``[tool.robotpy]`` asks for, or nothing if there is no such file or table.

    :raises SettingsError: with the file and line of a requirement that cannot be read
    """
    if not pyproject.is_file():
        return RobotPackages(None, (), (), {})
    file = TomlFile(pyproject)
    table = file.table_at("tool", "robotpy")
    if table is None:
        return RobotPackages(None, (), (), {})
    lines = {key: file.place_of("tool", "robotpy", key) for key in table}
    requires = [_requirement(each, lines["requires"]) for each in _texts(table, "requires", lines)]
    components = _texts(table, "components", lines)
    version = _version_in(table)
    if version == _IGNORED:
        return RobotPackages(None, (), tuple(requires), lines, only_requires=True)
    return RobotPackages(version, components, tuple(requires), lines)


def load_season_settings(pyproject: Path) -> list[SeasonSetting]:
    """Return what in ``[tool.robotpy]`` fits one season: its version of WPILib, and packages of one season.

    What is wrong there otherwise is not reported here.
    """
    if not pyproject.is_file():
        return []
    file = TomlFile(pyproject)
    table = file.table_at("tool", "robotpy") or {}
    found = []
    version = _version_in(table)
    if version is not None and (year := year_of(version)) is not None:
        where = file.place_of("tool", "robotpy", "robotpy_version")
        # A project from before 2026 may well run with WPILib 2026; 2027 spells every name in another way.
        found.append(SeasonSetting(f"robotpy_version is {version}", max(year, 2026), where))
    requires = table.get("requires")
    for each in requires if isinstance(requires, list) else ():
        if (only := _only_season(each)) is not None:
            where = file.place_of("tool", "robotpy", "requires")
            found.append(SeasonSetting(f"requires has {each!r}", only, where))
    return found


def _only_season(requirement: object) -> int | None:
    """Return the one known season that a requirement fits; None if it fits several or none, or is not WPILib's."""
    from packaging.requirements import InvalidRequirement, Requirement

    try:
        needed = Requirement(str(requirement))
    except InvalidRequirement:
        return None
    if not needed.name.lower().startswith(NUMBERED_BY_SEASON):
        return None
    named = [each.version.removesuffix(".*") for each in needed.specifier]
    fitting = [
        year
        for year in SEASONS
        for version in (f"{year}.9999", *named)
        if year_of(version) == year and needed.specifier.contains(version, prereleases=True)
    ]
    return fitting[0] if len(set(fitting)) == 1 else None


def _version_in(table: dict[str, object]) -> str | None:
    version = table.get("robotpy_version")
    return version if isinstance(version, str) else None


def _requirement(text: str, where: str) -> Requirement:
    from packaging.requirements import InvalidRequirement, Requirement  # here: a deploy seldom needs it

    try:
        return Requirement(text)
    except InvalidRequirement as invalid:
        raise SettingsError(f"requires = {text!r}: {str(invalid).splitlines()[0]}", where=where) from None


def _texts(table: dict[str, object], key: str, lines: dict[str, str]) -> tuple[str, ...]:
    value = table.get(key, [])
    if not isinstance(value, list):
        shown = str(value) if isinstance(value, str) else "NAME"
        raise SettingsError(f"{key} must be a list", where=lines[key], remedy=f'Write: {key} = ["{shown}"]')
    return tuple(each for each in value if isinstance(each, str))


def unknown_components(packages: RobotPackages) -> Iterator[tuple[str, str]]:
    """Yield each component that does not exist, as a sentence, and what was probably meant."""
    known = [*COMPONENTS, *_ON_DESKTOPS]
    for component in packages.components:
        if component not in known:
            meant = nearest(component, known)
            yield f"components has {component!r}, which does not exist", f"{meant[:1].upper()}{meant[1:]}"
