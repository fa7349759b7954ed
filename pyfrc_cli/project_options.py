"""The options that choose the robot project, and its robot class."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from pyfrc_core.wording import path_from

from .file_options import ReadPath, check_outputs

if TYPE_CHECKING:
    from pyfrc_core.project import Project

Function = TypeVar("Function", bound=Callable[..., Any])


#: The option ``--project``.
project_option = click.option(
    "--project",
    "directory",
    metavar="DIR",
    type=ReadPath(),
    help="The robot project. Default: the current directory, or the nearest one above it with a robot.py.",
)


def project_options(command: Function) -> Function:
    """Add ``--project``, ``--main`` and ``--robot-class`` to a command that loads the robot's code."""
    for option in (
        click.option(
            "--robot-class",
            metavar="NAME",
            help="The name of your robot class, if the file has several.",
        ),
        click.option(
            "--main",
            metavar="FILE",
            type=ReadPath(),
            help="The file with your robot class, if it is not called robot.py.",
        ),
        project_option,
    ):
        command = option(command)
    return command


def chosen_project(directory: Path | None, main: Path | None = None, robot_class: str | None = None) -> Project:
    """Return the project that the options choose, after a check of what the command will write.

    :raises UsageError: when one of its files would overwrite something, or cannot be written
    :raises ProjectError: when there is none, one of its files hides a library, or WPILib is of another season
    """
    from pyfrc_core.config.robotpy import load_season_settings
    from pyfrc_core.project import find_project
    from pyfrc_core.project.hidden_libraries import refuse_hidden_libraries
    from pyfrc_core.season import installed_wpilib, refuse_other_season

    project = find_project(directory, main, robot_class)
    refuse_hidden_libraries(project.root, project.main_file)
    refuse_other_season(installed_wpilib(), load_season_settings(project.pyproject))
    context = click.get_current_context()
    check_outputs(context, project)
    if context.info_name != "test":  # its summary has them, where they are seen
        for unreadable in project.unreadable_sources():
            click.secho(f"warning: {unreadable}", fg="yellow", err=True)
    return project


def from_here(file: Path, here: str = ".") -> str:
    """Return the path relative to the current directory, or to another one, where that is possible."""
    return Path(path_from(Path(here), file)).as_posix()
