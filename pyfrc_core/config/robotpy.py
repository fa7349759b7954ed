"""``[tool.robotpy]`` in pyproject.toml: the packages that a project needs on its robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import SettingsError, nearest
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

#: Components that install nothing on a robot.
_ON_DESKTOPS = ("romi", "sim", "xrp")


@dataclass(frozen=True)
class RobotPackages:
    """The packages that a project needs on its robot.

    :param version:    of WPILib; none: any
    :param components: the names of optional components
    :param requires:   further packages
    :param lines:      where in pyproject.toml each key is, as ``pyproject.toml:3``
    """

    version: str | None
    components: tuple[str, ...]
    requires: tuple[Requirement, ...]
    lines: dict[str, str]


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
    return RobotPackages(_version_in(table), components, tuple(requires), lines)


def load_robotpy_version(pyproject: Path) -> tuple[str | None, str | None]:
    """Return the version of WPILib that ``[tool.robotpy]`` asks for, and where: as of `load_robot_packages`.

    Nothing else in the table is read, so nothing else in it can be wrong.
    """
    if not pyproject.is_file():
        return None, None
    file = TomlFile(pyproject)
    version = _version_in(file.table_at("tool", "robotpy") or {})
    return version, file.place_of("tool", "robotpy", "robotpy_version") if version is not None else None


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
