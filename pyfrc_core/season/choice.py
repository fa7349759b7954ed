"""Which season is meant: that of the installed WPILib. A project that asks for another is refused, with the remedy."""

from __future__ import annotations

import importlib.metadata
import os

from ..errors import ProjectError
from .record import Season
from .season_2026 import SEASON_2026
from .season_2027 import SEASON_2027

#: Seasons that are being written. pyfrc refuses their WPILib, except in an environment with this variable: pyfrc's own
#: tests of them have it.
UNFINISHED, _TRY_UNFINISHED = (SEASON_2027,), "PYFRC_TRY_UNFINISHED_SEASONS"

#: The seasons that pyfrc knows entirely, by year.
SEASONS: dict[int, Season] = {
    season.year: season for season in (SEASON_2026, *(UNFINISHED if os.environ.get(_TRY_UNFINISHED) else ()))
}


def installed_wpilib() -> str | None:
    """Return the version of the installed WPILib, which is not imported; None if there is none."""
    try:
        return importlib.metadata.version("wpilib")
    except importlib.metadata.PackageNotFoundError:
        return None


def year_of(version: str) -> int | None:
    """Return the season's year, with which WPILib's versions begin."""
    year = version.partition(".")[0]
    return int(year) if year.isdecimal() else None


def season_of(version: str | None) -> Season:
    """Return the season of a version of WPILib; where pyfrc does not know it, the season that pyfrc is for."""
    return SEASONS.get(year_of(version or "") or 0, SEASON_2026)


def refuse_other_season(installed: str | None, wanted: str | None, where: str | None) -> None:
    """Refuse to go on with a WPILib that pyfrc does not know, or that is of another season than the project.

    A project of a season before those that pyfrc knows may well run with today's WPILib.

    :param installed: the version of the installed WPILib
    :param wanted: the ``robotpy_version`` of the project
    :param where: the place of ``robotpy_version``
    :raises ProjectError: with what to install
    """
    here = None if installed is None else year_of(installed)
    year = None if wanted is None else year_of(wanted)
    known = ", ".join(map(str, SEASONS))
    if installed is not None and here not in SEASONS:
        season = SEASONS.get(year or 0, SEASON_2026)
        raise ProjectError(
            f"wpilib {installed} is installed here, and this pyfrc runs robots of {known}",
            remedy=f'Install that season\'s: pip install "wpilib>={season.packages.wpilib},<{season.year + 1}"',
        )
    if year is None or here is None or year == here or year < min(SEASONS):
        return
    if year not in SEASONS:
        raise ProjectError(
            f"robotpy_version is {wanted}, and this pyfrc runs robots of {known}",
            where=where,
            remedy=f'Install the pyfrc of that season, or write: robotpy_version = "{installed}"',
        )
    raise ProjectError(
        f"robotpy_version is {wanted}, but wpilib {installed} is installed here",
        where=where,
        remedy=f'Install the project\'s: pip install "wpilib=={wanted}"; or write: robotpy_version = "{installed}"',
    )
