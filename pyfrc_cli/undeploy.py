"""`pyfrc undeploy`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import project_option
from .robot_options import errors_shown, json_option, project_if_any, robot_options, user_interface
from .shared_options import yes_option

if TYPE_CHECKING:
    from pyfrc_core.deploy.team import RobotChoice


@click.command("undeploy")
@project_option
@robot_options
@yes_option
@json_option
def command(directory: Path | None, choice: RobotChoice, yes: bool, as_json: bool) -> None:
    """Stop the robot program, and remove it from the robot with all earlier releases.

    \b
    Exit codes: 0 removed, 1 not removed, 2 wrong usage or no project, 4 possibly removed in part: see the message.
    """
    with errors_shown(choice, as_json):
        from pyfrc_core.deploy.session import undeploy

        undeploy(project_if_any(directory, choice), choice, user_interface(choice, as_json), confirmed=yes)
