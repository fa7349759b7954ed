"""All checks of `pyfrc doctor`, in the order of their dependencies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import PyfrcError
from ..project import Project, find_project
from .check_result import CheckResult, hint
from .computer import check_browser, check_extras, check_window
from .installed import find_installed
from .packages import check_imports, check_pyfrc, check_python, check_wpilib
from .robot import RobotSearch
from .robot_project import check_project, problem_from_error


@dataclass(frozen=True)
class DoctorOptions:
    """The options of `pyfrc doctor`.

    :param directory:  the project's directory, if the user specifies it
    :param main:       the main file, if the user specifies it
    :param class_name: the robot class, if the user specifies it
    :param look_for_robot: whether to check the robot as well
    :param robot:      the robot's address, if the user specifies it
    :param team:       the team number, if the user specifies it
    :param extras:     whether to report optional packages that are not installed
    """

    directory: Path | None = None
    main: Path | None = None
    class_name: str | None = None
    look_for_robot: bool = True
    robot: str | None = None
    team: int | None = None
    extras: bool = False


def examine(wanted: DoctorOptions) -> Iterator[CheckResult]:
    """Run all checks, and yield each result as soon as it is available."""
    project, about_project = _project(wanted)
    # The robot is checked in the background, since it may respond slowly.
    search = RobotSearch(project, wanted.robot, wanted.team) if wanted.look_for_robot else None
    installed = find_installed()
    yield from check_python()
    yield from check_pyfrc(installed)
    yield from check_wpilib(installed)
    yield from check_imports(installed)
    yield from check_browser()
    yield from check_window()
    if wanted.extras:
        yield from check_extras()
    if about_project is not None:
        yield about_project
    if project is not None:
        yield from check_project(project, installed)
    if search is not None:
        yield from search.findings()


def _project(wanted: DoctorOptions) -> tuple[Project | None, CheckResult | None]:
    """Return the robot project, or the reason why there is none."""
    try:
        project = find_project(wanted.directory, wanted.main, wanted.class_name)
        _ = project.settings  # read here, so that errors in the settings become a result
    except (PyfrcError, OSError) as error:
        named = wanted.directory or wanted.main
        if named is None and isinstance(error, PyfrcError) and error.where is None:
            return None, hint("project", "there is none here", "Go to your project's directory, or: pyfrc init")
        return None, problem_from_error("project", error, "Correct it there.")
    return project, None
