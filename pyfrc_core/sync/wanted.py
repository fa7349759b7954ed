"""What a project wants on its robot: the requirements that pip gets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..config.robotpy import load_robot_packages, unknown_components
from ..errors import SettingsError
from ..season import Season


@dataclass(frozen=True)
class Wanted:
    """The requirements of a project's robot.

    :param locked:  as the lock stores them, sorted
    :param version: the version of WPILib to take if the lock has none: this computer's; None if ``[tool.robotpy]``
        names one, or wants no WPILib
    """

    locked: tuple[str, ...]
    version: str | None = None


def load_wanted(pyproject: Path, season: Season, installed: str | None) -> Wanted:
    """Return what ``[tool.robotpy]`` asks for.

    pyfrc itself is left out: a robot does not need it.

    :param installed: the version of WPILib on this computer
    :raises SettingsError: with the file and line of a requirement that cannot be read, or that is not for wheels, and
        of a component that does not exist
    """
    packages = load_robot_packages(pyproject)
    for text, remedy in unknown_components(packages):
        raise SettingsError(text, where=packages.lines["components"], remedy=remedy)
    requires = []
    for each in packages.requires:
        if each.url is not None and not each.url.partition("#")[0].endswith(".whl"):
            raise SettingsError(
                f"requires has {str(each)!r}, which is not a wheel: sync takes only wheels",
                where=packages.lines["requires"],
                remedy=f'Build it: python -m pip wheel --no-deps --wheel-dir wheels "{each}". Then write '
                f'"{each.name}" there, and: pyfrc sync --find-links wheels',
            )
        if each.name != "pyfrc":
            requires.append(str(each))
    if packages.only_requires:
        return Wanted(tuple(sorted(requires)))
    extras = f"[{','.join(sorted(packages.components))}]" if packages.components else ""
    version = f"=={packages.version}" if packages.version else ""
    all_of_wpilib = f"{season.downloads.packages}{extras}{version}"
    return Wanted(tuple(sorted([all_of_wpilib, *requires])), None if packages.version else installed)


def robot_environment(season: Season) -> Mapping[str, str]:
    """Return the values of markers on the season's robots."""
    version = season.downloads.python
    return {
        "implementation_name": "cpython",
        "implementation_version": version,
        "os_name": "posix",
        "platform_machine": season.downloads.marker_machine,
        "platform_python_implementation": "CPython",
        "platform_release": "",
        "platform_system": "Linux",
        "platform_version": "",
        "python_full_version": version,
        "python_version": ".".join(version.split(".")[:2]),
        "sys_platform": "linux",
    }
