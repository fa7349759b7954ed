"""Find the robot project of a command, or explain why there is none."""

from __future__ import annotations

import re
from pathlib import Path

from ..config.settings import load_settings
from ..errors import ProjectError
from .project import MAIN_FILE, Project
from .walk import text_to_search

#: At most this many of the projects in subdirectories are named.
MOST_NAMED = 5

_ROBOT_CLASS = re.compile(
    r"^class \w+\((?:\w+\.)?(?:(?:Timed|TimedCommand|Magic)Robot|(?:Iterative)?RobotBase)\):", re.M
)


def find_project(start: Path | None = None, main: Path | None = None, class_name: str | None = None) -> Project:
    """Find the robot project of a command.

    :param start: the project's directory, if the user names it; otherwise the current one and its parents are searched
    :param main: the file with the robot class, if the user names it
    :raises ProjectError: with the directories and names that were searched for
    """
    if main is not None:
        file = (start / main if start is not None and not main.is_absolute() else main).absolute()
        if not file.is_file():
            what = f"{main} is a directory" if file.is_dir() else f"there is no file {main}"
            raise ProjectError(what, remedy="--main names the file with your robot class.")
        return Project(file.resolve(), class_name)
    if start is not None:
        if not start.is_dir():
            raise ProjectError(f"there is no directory {start}", remedy="--project names your robot project.")
        project = _project_in(start.resolve(), class_name)
        if project is None:
            raise _nothing_found(start, "in")
        return project
    here = Path.cwd()
    for directory in (here, *here.parents):
        project = _project_in(directory, class_name)
        if project is not None:
            return project
    raise _nothing_found(here, "in or above")


def _project_in(directory: Path, class_name: str | None) -> Project | None:
    pyproject = directory / "pyproject.toml"
    main = load_settings(pyproject).main
    if main is not None:
        file = directory / main
        if not file.is_file():
            raise ProjectError(f"main = {main!r} under [tool.pyfrc], but there is no such file", where=pyproject.name)
        return Project(file.resolve(), class_name, pyproject)
    file = directory / MAIN_FILE
    if file.is_file():
        return Project(file, class_name)
    if file.is_symlink() and not file.exists():
        raise ProjectError(f"a link to {file.readlink()}, which does not exist", where=file)
    return None


def _nothing_found(directory: Path, how: str) -> ProjectError:
    below = projects_below(directory)
    if below:
        also = f" (or {', '.join(f'./{each.as_posix()}' for each in below[1:])})" if len(below) > 1 else ""
        there = (directory / below[0] if how == "in" else below[0]).as_posix()
        there = f'"{there}"' if " " in there else there
        return ProjectError(
            f"there is no {MAIN_FILE} {how} {directory}, but there is one in ./{below[0].as_posix()}{also}",
            remedy=f"Go there with: cd {there}. Or name it with: --project {there}",
        )
    nearly = next(
        (file.name for file in directory.glob("*.py") if file.is_file() and file.name.lower() == MAIN_FILE), None
    )
    other = next((file.name for file in sorted(directory.glob("*.py")) if _defines_robot(file)), None)
    if nearly is None and other is not None:
        return ProjectError(
            f"no robot project found: there is no {MAIN_FILE} {how} {directory}, but a robot class in {other}",
            remedy=f'Rename {other} to {MAIN_FILE}, or write in pyproject.toml, under [tool.pyfrc]: main = "{other}"',
        )
    return ProjectError(
        f"no robot project found: there is no {MAIN_FILE} {how} {directory}"
        + (f" (but a {nearly}: rename it)" if nearly else ""),
        remedy="Go to your project's directory, name it with --project DIR, or make a new project with: pyfrc init",
    )


def _defines_robot(file: Path) -> bool:
    return _ROBOT_CLASS.search(text_to_search(file)) is not None


def projects_below(directory: Path) -> list[Path]:
    """Return the subdirectories that contain a robot project, as in a repository with several of them."""
    try:
        found = sorted(file.parent for file in directory.glob(f"*/{MAIN_FILE}") if file.is_file())
    except OSError:
        return []
    return [each.relative_to(directory) for each in found if not each.name.startswith(".")][:MOST_NAMED]
