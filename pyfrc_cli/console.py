"""`pyfrc console`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .project_options import project_options
from .robot_options import address_options, conversation, errors_shown, project_if_any

if TYPE_CHECKING:
    from pyfrc_core.deploy.reach import RobotChoice


@click.command("console", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
@address_options
@click.option("--nc-ds", is_flag=True, help="Also when no Driver Station is connected to the robot.")
def command(
    directory: Path | None, main: Path | None, robot_class: str | None, choice: RobotChoice, nc_ds: bool
) -> None:
    """Show what the robot program prints, until Ctrl-C; connects again whenever the robot goes away.

    Robots send it while a Driver Station is connected to them; --nc-ds imitates one. The console has no
    login: the robot's key is not checked.

    \b
    Exit codes: 0 ended by Ctrl-C; 1 no robot was found, or what listens there is not a robot's console;
    2 wrong usage or no project.
    """
    with errors_shown(choice):
        from pyfrc_core.deploy.session import show_console

        show_console(project_if_any(directory, main, robot_class, choice), choice, conversation(choice), nc_ds)
