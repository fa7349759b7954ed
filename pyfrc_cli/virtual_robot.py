"""`pyfrc virtual-robot`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from .verbosity import verbosity


@click.command("virtual-robot", context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--directory",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Where the robot keeps its programs and its SSH key between starts; else in your user data.",
)
@click.option(
    "--port",
    type=click.IntRange(1, 65535),
    metavar="N",
    help="The port of its SSH server; else the first free one from 2222 on.",
)
@click.option("--fresh", is_flag=True, help="Begin with a robot without programs; its SSH key stays.")
@click.argument("command", nargs=-1, metavar="[-- COMMAND...]")
def command(directory: Path | None, port: int | None, fresh: bool, command: tuple[str, ...]) -> None:
    """Start a robot on this computer, to deploy to: an SSH server, and the program in WPILib's simulation.

    Prints how to deploy to it, then what its program prints. Ctrl-C ends it; its programs are kept for the next start.

    With COMMAND, runs that with the robot's address as its last argument, and ends the robot when it is done. Example:

    \b
    pyfrc virtual-robot -- pyfrc deploy --robot

    \b
    Exit codes: 0 ended by Ctrl-C (with COMMAND: that of COMMAND), 1 it cannot be started, 2 wrong usage.
    """
    from pyfrc_core.virtual_robot.run import run_command, show

    if command:
        sys.exit(run_command(command, directory, port, fresh))
    # Asked for here: news come from other threads, too.
    quiet = verbosity().quiet
    show(directory, port, fresh, click.echo, (lambda text: None) if quiet else click.echo)
