"""The record of the season, and the places that cannot ask it: they must agree."""

from __future__ import annotations

import sys
from importlib.metadata import version
from pathlib import Path

from loops import for_each
from packaging.requirements import Requirement

from pyfrc_core._version import __version__
from pyfrc_core.deploy.targets import controller_of
from pyfrc_core.runtime.clock import KICKOFF
from pyfrc_core.season import CURRENT, FIELDS, SEASONS, Season

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PYPROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text("utf-8"))


def requirement(name: str) -> Requirement:
    """Return what pyproject.toml asks for."""
    project, groups = PYPROJECT["project"], PYPROJECT["dependency-groups"]
    more = [*project["optional-dependencies"].values(), *groups.values()]
    every = [*project["dependencies"], *(each for extra in more for each in extra if isinstance(each, str))]
    return next(found for found in map(Requirement, every) if found.name == name)


def test_the_current_season_is_that_of_the_installed_wpilib() -> None:
    assert CURRENT.year == int(version("wpilib").partition(".")[0])
    assert FIELDS[CURRENT.year] == CURRENT.field


def test_seasons_have_the_year_that_they_are_found_by() -> None:
    assert all(season.year == year == season.kickoff.year for year, season in SEASONS.items())


def test_robot_time_begins_at_kickoff() -> None:
    assert KICKOFF == 1_768_064_400  # recordings and hashes of this season depend on it


def test_the_version_is_of_a_season() -> None:
    assert int(__version__.split(".")[0]) in SEASONS


def test_wpilib_is_asked_for_as_new_projects_do() -> None:
    for name in ("wpilib", "robotpy-halsim-gui"):
        wpilib = requirement(name).specifier
        for season in SEASONS.values():
            assert wpilib.contains(season.packages.wpilib, prereleases=True)
            asked = Requirement(season.requirement).specifier
            assert asked.contains(season.packages.wpilib)  # a preview too, without --pre
            assert [year for year in SEASONS if asked.contains(f"{year}.9.9")] == [season.year]
        for other in (f"{max(SEASONS) + 1}.0.0a1", f"{max(SEASONS) + 1}.1.0", f"{min(SEASONS) - 1}.3.2"):
            assert not wpilib.contains(other, prereleases=True)
    for project_asks in map(Requirement, (CURRENT.packages.commands, CURRENT.packages.utilities)):
        (newest,) = [each.version for each in requirement(project_asks.name).specifier if each.operator == ">="]
        assert project_asks.specifier.contains(newest)


def test_without_pre_pip_takes_wpilib_2026() -> None:
    """A preview that the requirement named as its lower bound would be taken."""
    wpilib = requirement("wpilib").specifier
    offered = ["2025.3.2", "2026.2.2", "2027.0.0a2", "2027.0.0a6.post4", "2027.0.0a7", "2027.0.0b1", "2028.0.0a1"]
    assert not wpilib.prereleases
    assert [*wpilib.filter(offered, prereleases=False)] == ["2026.2.2"]
    assert [*wpilib.filter(offered, prereleases=True)] == ["2026.2.2", "2027.0.0a7", "2027.0.0b1"]


def test_the_robotpy_command_finds_our_commands() -> None:
    assert all(season.cli_plugins in PYPROJECT["project"]["entry-points"] for season in SEASONS.values())


@for_each("season", SEASONS.values())
def test_a_deploy_knows_the_controller_of_each_season(season: Season) -> None:
    assert controller_of(season).layout.home == season.controller.home
