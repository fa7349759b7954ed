"""`pyfrc create-physics`."""

from __future__ import annotations

from pathlib import Path

import click

from .project_options import chosen_project, from_here, project_options
from .verbosity import hint


@click.command("create-physics", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
def command(directory: Path | None, main: Path | None, robot_class: str | None) -> None:
    """Write a physics.py and a sim/config.json that fit the robot.

    The robot's program is started here, with simulated devices, to see which motors, encoders and gyros it has;
    then its sticks are pushed one after the other, to see which motors drive it, and which way. It takes about a
    second.

    A file that is there already is left alone; to have it written anew, move it away first.

    \b
    Exit codes: 0 the files are there, written now or before,
    1 the robot's code failed, 2 wrong usage.
    """
    from pyfrc_core.physics.create.files import create_physics

    project = chosen_project(directory, main, robot_class)
    done = create_physics(project)
    if done.problem:
        click.secho(f"warning: the sticks could not be tried: {done.problem}", fg="yellow", err=True)
    for line in done.recognised:
        hint(line)
    for note in done.notes:
        hint(f"note: {note}")
    for file, mistake in done.left_alone.items():
        hint(f"left alone: {from_here(file)} (exists)")
        if mistake:
            click.secho(f"warning: what is there is not valid: {mistake}", fg="yellow", err=True)
    for file in done.written:
        hint(f"wrote {from_here(file)}")
    if project.physics_file in done.written:
        physics = from_here(project.physics_file)
        hint(f"\nChange the numbers at the top of {physics} to your robot's; pyfrc test uses it from now on.")
