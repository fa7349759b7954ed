"""All checks of `pyfrc doctor`, in the order of their dependencies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..browser import why_no_browser
from ..config.robotpy import load_season_settings
from ..display import WITHOUT_DISPLAY, has_display, has_tkinter
from ..errors import PyfrcError, SettingsError
from ..project import Project, find_project
from ..season import CURRENT, Season, SeasonSetting, installed_wpilib, season_of
from ..shell import getting_tkinter
from ..sync import LOCK_FILE, load_lock, lock_file_of
from ..sync.install import different_here
from ..sync.synchronize import differences
from ..wording import counted
from .check_result import CheckResult, hint, ok
from .installed import find_installed
from .packages import check_imports, check_pyfrc, check_python, check_wpilib
from .robot import RobotSearch
from .robot_project import check_project, problem_from_error
from .steps import first_missing

_SYNC, _MAX_NAMED = "sync", 3


def check_browser() -> Iterator[CheckResult]:
    """Check whether `pyfrc sim` can open its page."""
    if why := why_no_browser():
        yield hint(
            "browser",
            f"pyfrc sim cannot open one: {why}",
            "It prints the address of its page. Open that in a browser, on another computer through a forwarded port.",
        )
    else:
        yield ok("browser", "pyfrc sim opens its page in one")


def check_window() -> Iterator[CheckResult]:
    """Check whether `pyfrc sim --ui tk` can show its window."""
    if not has_display():
        yield hint("window", "pyfrc sim --ui tk cannot show one: there is no display", WITHOUT_DISPLAY)
    elif not has_tkinter():
        yield hint("window", "pyfrc sim --ui tk cannot show one: this Python has no tkinter", getting_tkinter())
    else:
        yield ok("window", "there is a display, and tkinter")


@dataclass(frozen=True)
class DoctorOptions:
    """The options of `pyfrc doctor`.

    :param directory:  the project's directory, if the user specifies it
    :param main:       the main file, if the user specifies it
    :param class_name: the robot class, if the user specifies it
    :param look_for_robot: whether to check the robot as well
    :param robot:      the robot's address, if the user specifies it
    :param team:       the team number, if the user specifies it
    """

    directory: Path | None = None
    main: Path | None = None
    class_name: str | None = None
    look_for_robot: bool = True
    robot: str | None = None
    team: int | None = None


def examine(wanted: DoctorOptions) -> Iterator[CheckResult]:
    """Run all checks, and yield each result as soon as it is available."""
    project, about_project = _project(wanted)
    # The robot is checked in the background, since it may respond slowly.
    search = RobotSearch(project, wanted.robot, wanted.team) if wanted.look_for_robot else None
    installed = find_installed()
    yield from check_python()
    settings = _season_settings(project)
    yield from check_pyfrc(installed, season_of(installed_wpilib(), settings))
    yield from check_wpilib(installed, settings)
    yield from check_imports(installed)
    yield from check_browser()
    yield from check_window()
    if about_project is not None:
        yield about_project
    downloads: list[CheckResult] = []
    if project is not None:
        yield from check_project(project, installed, settings)
        wpilib = installed.get("wpilib")
        if wpilib is not None and all(each.year == CURRENT.year for each in settings):
            downloads = list(check_downloads(project, CURRENT, wpilib.version))
            yield from downloads
    if search is not None:
        yield from search.findings()
        if (missing := search.missing_step()) is not None:
            yield first_missing(downloads[0] if downloads else None, missing)


def _season_settings(project: Project | None) -> list[SeasonSetting]:
    try:
        return load_season_settings(project.pyproject) if project is not None else []
    except SettingsError:  # `check_project` reports it
        return []


def _project(wanted: DoctorOptions) -> tuple[Project | None, CheckResult | None]:
    """Return the robot project, or the reason why there is none."""
    try:
        project = find_project(wanted.directory, wanted.main, wanted.class_name)
        _ = project.settings  # read here, so that errors in the settings become a result
    except (PyfrcError, OSError) as error:
        named = wanted.directory or wanted.main
        if named is None and isinstance(error, PyfrcError) and error.where is None:
            return None, hint("project", error.message, error.remedy or "")
        return None, problem_from_error("project", error, "Correct it there.")
    return project, None


def check_downloads(project: Project, season: Season, installed: str) -> Iterator[CheckResult]:
    """Check the project's lock, the files that it names, and whether the same versions are installed here.

    :param installed: the version of WPILib on this computer
    """
    try:
        lock = load_lock(lock_file_of(project), season)
        if lock is None:
            text = f"there is no {LOCK_FILE}: what the robot needs was not downloaded with pyfrc"
            yield hint(_SYNC, text, "With internet: pyfrc sync. A robot that has all it needs works without.")
            return
        found = list(differences(project, season, installed))
    except (PyfrcError, OSError) as error:
        yield problem_from_error(_SYNC, error, "pyfrc sync --upgrade")
        return
    if found:
        more = f"; and {len(found) - _MAX_NAMED} more" if len(found) > _MAX_NAMED else ""
        yield hint(_SYNC, f"{'; '.join(found[:_MAX_NAMED])}{more}", "With internet: pyfrc sync")
    else:
        yield ok(_SYNC, f"{counted(len(lock.files), 'file')} for the {lock.controller} are on this computer")
    if others := list(different_here(lock)):
        more = f" and {len(others) - _MAX_NAMED} more" if len(others) > _MAX_NAMED else ""
        text = f"this computer has {', '.join(others[:_MAX_NAMED])}{more}"
        yield hint(_SYNC, text, "For the robot's versions here, too: pyfrc sync --install")
