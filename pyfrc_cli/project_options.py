"""The options that say which robot project a command is about; the same for every command."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from pyfrc_core.project import Project

Function = TypeVar("Function", bound=Callable[..., Any])


def project_options(command: Function) -> Function:
    """Adds ``--project``, ``--main`` and ``--robot-class``."""
    for option in (
        click.option(
            "--robot-class",
            metavar="NAME",
            help="The robot class, when the file has several.",
        ),
        click.option(
            "--main",
            metavar="FILE",
            type=click.Path(path_type=Path),
            help="The file with your robot class, when it is not called robot.py.",
        ),
        click.option(
            "--project",
            "directory",
            metavar="DIR",
            type=click.Path(path_type=Path),
            help="Your robot project. Default: the current directory, or the nearest above it with a robot.py.",
        ),
    ):
        command = option(command)
    return command


def chosen_project(directory: Path | None, main: Path | None, robot_class: str | None) -> Project:
    """The project that the options choose.

    :raises ProjectError: also when one of its files hides a library
    """
    from pyfrc_core.project import find_project
    from pyfrc_core.project.hidden_libraries import refuse_hidden_libraries

    project = find_project(directory, main, robot_class)
    refuse_hidden_libraries(project.root, project.main_file)
    return project


def from_here(file: Path) -> str:
    """`file` as the user's shell finds it."""
    try:
        return Path(os.path.relpath(file)).as_posix()
    except ValueError:  # on Windows: on another drive
        return str(file)
