"""`pyfrc virtual-robot`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from .file_options import WrittenDirectory
from .verbosity import verbosity


@click.command("virtual-robot")
@click.option(
    "--directory",
    type=WrittenDirectory(file_okay=False),
    metavar="DIR",
    help="Where the robot stores its programs and its SSH key. Default: in your user data.",
)
@click.option(
    "--controller",
    metavar="NAME",
    help="The controller that it stands for: roborio or systemcore. Default: the season's.",
)
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    metavar="N",
    help="The port of its SSH server. Default: that of the last start, else the first free one from 2222 on.",
)
@click.option("--fresh", is_flag=True, help="Start without programs. The SSH key stays.")
@click.argument("command", nargs=-1, metavar="[-- COMMAND...]")
def command(
    directory: Path | None, controller: str | None, port: int | None, fresh: bool, command: tuple[str, ...]
) -> None:
    """Start a virtual robot on this computer: an SSH server, and the program in WPILib's simulation.

    Shows how to deploy to it, then its program's output. Ctrl-C stops it. Its programs are kept for the next start.

    With COMMAND, runs this command with the robot's address as last argument, then stops the robot. Example:

    \b
    pyfrc virtual-robot -- pyfrc deploy --robot

    \b
    Exit codes: 130 ended by Ctrl-C (with COMMAND: its exit code), 1 cannot be started, 2 wrong usage.
    """
    from pyfrc_core.virtual_robot.robot import run_command, show

    if command:
        sys.exit(run_command(command, directory, controller, port, fresh))
    # Read here, since messages also come from other threads.
    quiet = verbosity().quiet
    show(directory, controller, port, fresh, click.echo, (lambda text: None) if quiet else click.echo)
