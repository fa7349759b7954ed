"""`pyfrc undeploy`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import project_options
from .robot_options import conversation, json_option, project_if_any, robot_options, told_as_json

if TYPE_CHECKING:
    from pyfrc_core.deploy.reach import RobotChoice


@click.command("undeploy", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
@robot_options
@click.option("-y", "--yes", is_flag=True, help="Do not ask.")
@json_option
def command(
    directory: Path | None, main: Path | None, robot_class: str | None, choice: RobotChoice, yes: bool, as_json: bool
) -> None:
    """Stop the robot program and remove it from the robot, with all its earlier releases.

    \b
    Exit codes: 0 removed, 1 not removed, 2 wrong usage or no project.
    """
    with told_as_json(as_json):
        from pyfrc_core.deploy.session import undeploy

        undeploy(project_if_any(directory, main, robot_class, choice), choice, conversation(as_json), sure=yes)
