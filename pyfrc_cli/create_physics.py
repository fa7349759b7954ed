"""The command `pyfrc create-physics`."""

from __future__ import annotations

from pathlib import Path

import click

from pyfrc_core.collector import collector_paused

from .project_options import chosen_project, from_here, project_options
from .verbosity import hint


@click.command("create-physics", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
def command(directory: Path | None, main: Path | None, robot_class: str | None) -> None:
    """Write a physics.py and a sim/config.json that fit the robot.

    The robot program is started on this computer, with simulated devices, to find its motors, encoders and gyros. Then
    each joystick axis is moved, to find the motors that drive the robot, and their directions. It takes about a second.

    Existing files are not changed. To write one again, move it away first.

    \b
    Exit codes: 0 the files exist, written now or before,
    1 the robot's code failed, 2 wrong usage.
    """
    with collector_paused():
        from pyfrc_core.physics.create.files import create_physics

    project = chosen_project(directory, main, robot_class)
    done = create_physics(project)
    if done.problem:
        click.secho(f"warning: the joysticks could not be tested: {done.problem}", fg="yellow", err=True)
    for line in done.recognised:
        hint(line)
    for note in done.notes:
        hint(f"note: {note}")
    for file, mistake in done.unchanged.items():
        hint(f"unchanged: {from_here(file)} (exists)")
        if mistake:
            click.secho(f"warning: the existing file is not valid: {mistake}", fg="yellow", err=True)
    for file in done.written:
        hint(f"wrote {from_here(file)}")
    if project.physics_file in done.written:
        physics = from_here(project.physics_file)
        hint(f"\nChange the numbers at the top of {physics} to your robot's; pyfrc test uses it from now on.")
