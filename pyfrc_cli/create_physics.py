"""The command `pyfrc create-physics`."""

from __future__ import annotations

from pathlib import Path

import click

from pyfrc_core.errors import PyfrcError
from pyfrc_core.processes.loading import loading

from .project_options import chosen_project, from_here, project_options
from .verbosity import hint, verbosity

#: How many failures are listed, and how much of the line of each.
_MOST_FAILURES, _WIDTH = 10, 150


@click.command("create-physics")
@project_options
def command(directory: Path | None, main: Path | None, robot_class: str | None) -> None:
    """Write a physics.py and a sim/config.json that fit the robot.

    The robot program is started on this computer, with simulated devices, to find its motors, encoders and gyros. Then
    each joystick axis is moved, to find the motors that drive the robot, and their directions. It takes about a second.

    Then the project's tests are run with the new physics.py. If one fails that did not fail before, or that needs a
    physics.py, it does not stay in its place.

    Existing files are not changed. To write one again, move it away first.

    \b
    Exit codes: 0 the files exist, written now or before,
    1 the robot's code failed, or a test with the new physics.py, 2 wrong usage.
    """
    project = chosen_project(directory, main, robot_class)
    with loading(verbosity().quiet):
        from pyfrc_core.physics.create.files import create_physics
    done = create_physics(project)
    if done.problem:
        click.secho(f"warning: the joysticks could not be tested: {done.problem}", fg="yellow", err=True)
    for line in done.recognised:
        hint(line)
    for note in done.notes:
        hint(f"note: {note}")
    for file in done.unchanged:
        hint(f"unchanged: {from_here(file)} (exists)")
    for file in done.written:
        hint(f"wrote {from_here(file)}")
    new, old = (done.failures.new, done.failures.old) if done.failures else ([], [])
    if done.proposal is not None:
        number = f"{len(new)} of the project's tests fail" if len(new) > 1 else "a test fails"
        raise PyfrcError(
            f"physics.py was not put in place, since {number} with it:{_listed(new)}",
            remedy=f"Correct the numbers in {from_here(done.proposal)} and answer its questions (TODO), copy it beside "
            "robot.py, and run pyfrc test.",
        )
    if project.physics_file in done.written:
        physics = from_here(project.physics_file)
        tested = "The project has no tests to run with it. " if done.failures is None else "The project's tests pass. "
        if old:
            tested = f"Of the project's tests, those that fail now failed without it, too:{_listed(old)}\n\n"
        hint(f"\n{tested}Change the numbers at the top of {physics} to your robot's; pyfrc test uses it from now on.")


def _listed(failures: list[str]) -> str:
    lines = [line if len(line) <= _WIDTH else f"{line[:_WIDTH]}..." for line in failures[:_MOST_FAILURES]]
    if len(failures) > _MOST_FAILURES:
        lines.append(f"and {len(failures) - _MOST_FAILURES} more")
    return "".join(f"\n  {line}" for line in lines)
