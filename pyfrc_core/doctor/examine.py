"""All that `pyfrc doctor` looks at, in the order in which one thing rests on another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import PyfrcError
from ..project import Project, find_project
from .computer import examine_extras, examine_window
from .findings import Finding, hint
from .imports import examine_imports
from .installed import find_installed
from .packages import examine_pyfrc, examine_python, examine_wpilib
from .robot import RobotSearch
from .robot_project import examine_project, problem_of


@dataclass(frozen=True)
class Examination:
    """What is to be looked at.

    :param directory:   the project's, when the user names it
    :param main:        its main file, when the user does
    :param class_name:  its robot class, when the user does
    :param look_for_robot: whether the robot is looked for, too
    :param robot:       its address, when the user names it
    :param team:        the team's number, when the user names it
    """

    directory: Path | None = None
    main: Path | None = None
    class_name: str | None = None
    look_for_robot: bool = True
    robot: str | None = None
    team: int | None = None


def examine(wanted: Examination) -> Iterator[Finding]:
    """Look at everything; each finding is answered as soon as it is there."""
    project, about_project = _project(wanted)
    # The robot may take its time to answer, while the rest is looked at.
    search = RobotSearch(project, wanted.robot, wanted.team) if wanted.look_for_robot else None
    installed = find_installed()
    yield from examine_python()
    yield from examine_pyfrc(installed)
    yield from examine_wpilib(installed)
    yield from examine_imports(installed)
    yield from examine_window()
    yield from examine_extras()
    if about_project is not None:
        yield about_project
    if project is not None:
        yield from examine_project(project, installed)
    if search is not None:
        yield from search.findings()


def _project(wanted: Examination) -> tuple[Project | None, Finding | None]:
    """The robot project, or why there is none."""
    try:
        project = find_project(wanted.directory, wanted.main, wanted.class_name)
        _ = project.settings  # read here, where what is wrong in them can be told
    except (PyfrcError, OSError) as error:
        named = wanted.directory or wanted.main
        if named is None and isinstance(error, PyfrcError) and error.where is None:
            return None, hint("project", "there is none here", "Go to your project's directory, or: pyfrc init")
        return None, problem_of("project", error, "Correct it there.")
    return project, None
