"""Which season is meant: that of the installed WPILib. A project that asks for another is refused, with the remedy."""

from __future__ import annotations

import importlib.metadata
import pkgutil
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from ..errors import ProjectError
from .record import Season


def _find_seasons() -> dict[int, Season]:
    """Return the records of the modules here that are named after a season: one can be deleted without a change."""
    found = {}
    for module in pkgutil.iter_modules([str(Path(__file__).parent)]):
        prefix, _, year = module.name.partition("_")
        if prefix == "season":
            record: Season = getattr(import_module(f"{__package__}.{module.name}"), f"SEASON_{year}")
            found[record.year] = record
    return dict(sorted(found.items()))


#: The seasons that pyfrc knows, by year.
SEASONS = _find_seasons()


class SeasonSetting(NamedTuple):
    """A setting of a project that fits one season.

    :param text:  what it says, such as ``robotpy_version is 2026.2.2``
    :param year:  the season's year
    :param where: its place, such as ``pyproject.toml:2``
    """

    text: str
    year: int
    where: str


def installed_wpilib() -> str | None:
    """Return the version of the installed WPILib, which is not imported; None if there is none."""
    try:
        version: str | None = importlib.metadata.version("wpilib")
    except importlib.metadata.PackageNotFoundError:
        return None
    return version or None  # what an incomplete removal has left may have no version


def year_of(version: str) -> int | None:
    """Return the season's year, with which WPILib's versions begin."""
    year = version.partition(".")[0]
    return int(year) if year.isdecimal() else None


def season_of(version: str | None, settings: Sequence[SeasonSetting] = ()) -> Season:
    """Return the season of a version of WPILib.

    Without one, or where pyfrc does not know its season, return the season of the project's first setting; without
    settings, the oldest season that pyfrc knows.
    """
    years = [year_of(version or ""), *(each.year for each in settings)]
    return next((SEASONS[year] for year in years if year in SEASONS), SEASONS[min(SEASONS)])


def refuse_unknown_wpilib(installed: str | None, settings: Sequence[SeasonSetting] = ()) -> None:
    """Refuse to go on without WPILib, or with one that pyfrc does not know.

    :param installed: the version of the installed WPILib; None if there is none
    :param settings:  the project's settings that fit one season
    :raises ProjectError: with what to install
    """
    season = season_of(installed, settings)
    if installed is None:
        wrong = "WPILib is not installed here"
    elif year_of(installed) not in SEASONS:
        wrong = f"wpilib {installed} is installed here, and this pyfrc runs robots of {_KNOWN}"
    elif _is_older_prerelease(installed, season.packages.wpilib):
        wrong = f"wpilib {installed} is installed here, and this pyfrc needs {season.packages.wpilib} or newer"
    else:
        return
    raise ProjectError(wrong, remedy=f'Install the one of {season.year}: pip install "{season.requirement}"')


def refuse_other_season(installed: str | None, settings: Sequence[SeasonSetting]) -> None:
    """Refuse to go on with a WPILib that pyfrc does not know, or that is of another season than the project.

    :param installed: the version of the installed WPILib; None if there is none
    :param settings:  the project's settings that fit one season
    :raises ProjectError: with what to install, or to write
    """
    for other in settings[1:]:
        if other.year != settings[0].year:
            raise ProjectError(
                f"{settings[0].text}, but {other.text} in {other.where}, which is of another season",
                where=settings[0].where,
                remedy="Write packages of one season there.",
            )
    refuse_unknown_wpilib(installed, settings)
    if not settings or installed is None:
        return
    wanted = settings[0]
    if wanted.year == year_of(installed):
        return
    here = year_of(installed) or 0
    rewrite = f", or rewrite it for {here}: pyfrc migrate" if wanted.year < here else ""
    if wanted.year not in SEASONS:
        raise ProjectError(
            f"{wanted.text}, and this pyfrc runs robots of {_KNOWN}",
            where=wanted.where,
            remedy=f'Install the pyfrc of that season, or write: robotpy_version = "{installed}"{rewrite}',
        )
    raise ProjectError(
        f"{wanted.text}, but wpilib {installed} is installed here",
        where=wanted.where,
        remedy=f'Install the project\'s: pip install "{SEASONS[wanted.year].requirement}"; '
        f'or, if its code is for {here}, write: robotpy_version = "{installed}"{rewrite}',
    )


_KNOWN = " and ".join(map(str, SEASONS))


def _is_older_prerelease(version: str, oldest: str) -> bool:
    """Return whether this is a preview of a season from before the oldest one that pyfrc runs with."""
    if version == oldest:
        return False
    from packaging.version import InvalidVersion, Version  # here: the usual case needs none

    try:
        return Version(version).is_prerelease and Version(version) < Version(oldest)
    except InvalidVersion:
        return False
