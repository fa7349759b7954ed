"""The command `pyfrc create-physics`."""

from __future__ import annotations

from pathlib import Path

import click

from pyfrc_core.collector import collector_paused
from pyfrc_core.errors import PyfrcError

from .project_options import chosen_project, from_here, project_options
from .verbosity import hint

#: How many failures are listed.
_MOST_FAILURES = 10


@click.command("create-physics", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
def command(directory: Path | None, main: Path | None, robot_class: str | None) -> None:
    """Write a physics.py and a sim/config.json that fit the robot.

    The robot program is started on this computer, with simulated devices, to find its motors, encoders and gyros. Then
    each joystick axis is moved, to find the motors that drive the robot, and their directions. It takes about a second.

    Then the project's tests are run with the new physics.py, in a copy of the project. If one fails, it is not put in
    place.

    Existing files are not changed. To write one again, move it away first.

    \b
    Exit codes: 0 the files exist, written now or before,
    1 the robot's code failed, or a test with the new physics.py, 2 wrong usage.
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
    if done.proposal is not None and done.failures:
        number = f"{len(done.failures)} of the project's tests fail" if len(done.failures) > 1 else "a test fails"
        failed = "".join(f"\n  {line}" for line in done.failures[:_MOST_FAILURES])
        rest = len(done.failures) - _MOST_FAILURES
        raise PyfrcError(
            f"physics.py was not put in place, since {number} with it:{failed}"
            + (f"\n  and {rest} more" if rest > 0 else ""),
            remedy=f"Correct the numbers in {from_here(done.proposal)}, copy it beside robot.py, and run pyfrc test.",
        )
    if project.physics_file in done.written:
        physics = from_here(project.physics_file)
        tested = "The project has no tests to run with it." if done.failures is None else "The project's tests pass."
        hint(f"\n{tested} Change the numbers at the top of {physics} to your robot's; pyfrc test uses it from now on.")
