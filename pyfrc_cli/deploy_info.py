"""`pyfrc deploy-info`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import project_option
from .robot_options import errors_shown, json_option, project_if_any, robot_options, user_interface

if TYPE_CHECKING:
    from pyfrc_core.deploy.team import RobotChoice


@click.command("deploy-info")
@project_option
@robot_options
@json_option
def command(directory: Path | None, choice: RobotChoice, as_json: bool) -> None:
    """Show the program on the robot: who deployed it, when, from which commit; and the kept releases.

    \b
    Exit codes: 0 shown, 1 the robot cannot be reached, 2 wrong usage or no project.
    """
    with errors_shown(choice, as_json):
        from pyfrc_core.deploy.session import show_info

        show_info(project_if_any(directory, choice), choice, user_interface(choice, as_json))
