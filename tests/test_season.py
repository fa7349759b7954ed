"""The record of the season, and the places that cannot ask it: they must agree."""

from __future__ import annotations

import sys
from dataclasses import FrozenInstanceError
from importlib.metadata import version
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from pyfrc_core._version import __version__
from pyfrc_core.deploy.targets import controller_of
from pyfrc_core.runtime.clock import KICKOFF
from pyfrc_core.season import CURRENT, FIELDS, SEASONS

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PYPROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text("utf-8"))


def requirement(name: str) -> Requirement:
    """Return what pyproject.toml asks for."""
    project = PYPROJECT["project"]
    every = [*project["dependencies"], *(each for extra in project["optional-dependencies"].values() for each in extra)]
    return next(found for found in map(Requirement, every) if found.name == name)


def test_the_current_season_is_that_of_the_installed_wpilib() -> None:
    assert CURRENT.year == int(version("wpilib").partition(".")[0])
    assert FIELDS[CURRENT.year] == CURRENT.field


def test_seasons_have_the_year_that_they_are_found_by() -> None:
    assert all(season.year == year == season.kickoff.year for year, season in SEASONS.items())


def test_a_season_cannot_be_changed() -> None:
    with pytest.raises(FrozenInstanceError):
        CURRENT.year = 1992  # type: ignore[misc]


def test_robot_time_begins_at_kickoff() -> None:
    assert KICKOFF == 1_768_064_400  # recordings and hashes of this season depend on it


def test_the_version_is_of_the_season() -> None:
    assert __version__.split(".")[0] == str(CURRENT.year)


def test_wpilib_is_asked_for_as_new_projects_do() -> None:
    wpilib = requirement("wpilib").specifier
    assert wpilib.contains(CURRENT.packages.wpilib)
    assert not wpilib.contains(f"{CURRENT.year + 1}.1.0")
    for project_asks in map(Requirement, (CURRENT.packages.commands, CURRENT.packages.utilities)):
        (newest,) = [each.version for each in requirement(project_asks.name).specifier if each.operator == ">="]
        assert project_asks.specifier.contains(newest)


def test_the_robotpy_command_finds_our_commands() -> None:
    assert CURRENT.cli_plugins in PYPROJECT["project"]["entry-points"]


def test_a_deploy_knows_the_controller_of_each_season() -> None:
    for season in SEASONS.values():
        assert controller_of(season).layout.home == season.controller.home
