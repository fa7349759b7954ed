"""`pyfrc logs`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .file_options import WrittenDirectory, check_outputs
from .project_options import project_option
from .robot_options import errors_shown, json_option, project_if_any, robot_options, user_interface
from .shared_options import yes_option

if TYPE_CHECKING:
    from pyfrc_core.deploy.team import RobotChoice


@click.command("logs")
@project_option
@robot_options
@click.option(
    "--into",
    type=WrittenDirectory(file_okay=False),
    metavar="DIRECTORY",
    help="Write them into this directory. Default: logs, in the project.",
)
@click.option("--delete", is_flag=True, help="Remove them from the robot after that, but none of the last 30 s.")
@yes_option
@json_option
@click.argument("wanted", nargs=-1, metavar="[NAME]...")
def command(
    directory: Path | None,
    choice: RobotChoice,
    wanted: tuple[str, ...],
    into: Path | None,
    delete: bool,
    yes: bool,
    as_json: bool,
) -> None:
    """List the logs on the robot and on its USB stick, or fetch some of them.

    NAME is a word in the names of logs, such as Q12 or 20260321, or all. If the connection is cut, the next
    command goes on from there. A log is here under its name only when its hash is the robot's.

    \b
    Exit codes: 0 listed or fetched, 1 not, 2 wrong usage, no project, or no such log.
    """
    with errors_shown(choice, as_json):
        from pyfrc_core.deploy.logs import LogRequest, fetch_logs

        request = LogRequest(wanted, into, delete, yes)
        project = project_if_any(directory, choice)
        check_outputs(click.get_current_context(), project)
        fetch_logs(project, choice, request, user_interface(choice, as_json))
