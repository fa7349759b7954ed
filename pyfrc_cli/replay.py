"""`pyfrc replay`."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from .project_options import chosen_project, project_options
from .verbosity import hint


@click.command("replay", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
@click.option("--until", type=click.FloatRange(min=0), metavar="T", help="End at this robot time, in seconds.")
@click.option(
    "--trace",
    metavar="FILE",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Write what the robot does, as JSON lines with a hash at the end.",
)
@click.option(
    "--picture",
    metavar="FILE",
    type=click.Path(path_type=Path, dir_okay=False),
    help="Draw the driven path on the field, such as path.png.",
)
@click.argument("file", type=click.Path(path_type=Path))
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    until: float | None,
    trace: Path | None,
    picture: Path | None,
    file: Path,
) -> None:
    """Run the robot as an input script says: one that pyfrc fuzz or pyfrc test --record has written.

    \b
    Exit codes: 0 it did what it did when recorded, or the script does not tell;
    1 it did something else, or its code failed; 2 wrong usage, or no such script.
    """
    from pyfrc_core.replay import replay

    project = chosen_project(directory, main, robot_class)
    if picture is not None:
        from pyfrc_core.sim.simulate import draw_script

        draw_script(project, file, picture, until)
        hint(f"wrote {picture}")
    replayed = replay(project, file, until=until, trace=trace)
    hint(f"replayed {replayed.seconds:.2f} s of robot time")
    if replayed.failure is not None:
        click.secho(f"then {replayed.failure}", fg="red")
    if replayed.difference is not None:
        where = replayed.difference
        click.secho(f"It differs from the recorded trace, first at {where.now:.2f} s:", fg="red")
        click.echo(f"  {where.path} was {json.dumps(where.recorded)}, is {json.dumps(where.replayed)}")
    elif replayed.equal:
        hint("The trace equals the recorded one.")
    elif replayed.equal is not None:
        click.echo("The trace differs from the recorded one.")
    sys.exit(1 if replayed.failure is not None or replayed.difference is not None or replayed.equal is False else 0)
