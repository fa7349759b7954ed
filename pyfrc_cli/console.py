"""`pyfrc console`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import project_option
from .robot_options import (
    address_options,
    errors_shown,
    nc_ds_option,
    project_if_any,
    robot_options,
    user_interface,
)

if TYPE_CHECKING:
    from pyfrc_core.deploy.team import RobotChoice


def is_over_ssh() -> bool:
    """Return whether the output of the season's robots comes over SSH, with a login."""
    from pyfrc_core.deploy.targets import controller_of
    from pyfrc_core.season import CURRENT

    return bool(controller_of(CURRENT).layout.output)


@click.command("console")
@project_option
@(robot_options if is_over_ssh() else address_options)
@nc_ds_option
def command(directory: Path | None, choice: RobotChoice, nc_ds: bool) -> None:
    """Show the robot program's output until Ctrl-C. Reconnects after a lost connection.

    A roboRIO sends the output only while a Driver Station is connected to it; --nc-ds imitates one. Its
    console has no login, so its key is not checked. A SystemCore's output is read over SSH, as by a deploy.

    \b
    Exit codes: 130 ended by Ctrl-C; 1 no robot was found, or the server is not a robot's console;
    2 wrong usage or no project.
    """
    with errors_shown(choice):
        from pyfrc_core.deploy.session import show_console

        show_console(project_if_any(directory, choice), choice, user_interface(choice), nc_ds)
