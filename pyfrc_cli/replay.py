"""The command `pyfrc replay`."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from pyfrc_core.processes.loading import loading

from .file_options import ReadPath, WrittenFile
from .project_options import chosen_project, project_options
from .shared_options import TRACE, page_option
from .verbosity import hint, verbosity


@click.command("replay")
@project_options
@click.option("--until", type=click.FloatRange(min=0), metavar="T", help="End at this robot time, in seconds.")
@click.option(
    "--trace",
    metavar="FILE",
    type=WrittenFile(),
    help=f"Write a trace of the robot: {TRACE}",
)
@page_option("the run", "run.html")
@click.argument("file", type=ReadPath())
def command(
    directory: Path | None,
    main: Path | None,
    robot_class: str | None,
    until: float | None,
    trace: Path | None,
    page: Path | None,
    file: Path,
) -> None:
    """Run the robot with the inputs of a script that pyfrc fuzz or pyfrc test --record has written.

    \b
    Exit codes: 0 the trace equals the recorded one, or none was recorded, or a vendor's devices do not repeat;
    1 it differs, or the robot's code failed; 2 wrong usage, or no such script.
    """
    project = chosen_project(directory, main, robot_class)
    with loading(verbosity().quiet):
        from pyfrc_core.compat.unrepeatable import explain_unrepeatable
        from pyfrc_core.replay import replay
    result = replay(project, file, until=until, trace=trace, say=click.echo)
    if page is not None:
        from pyfrc_core.sim.page_file import write_replay_page

        write_replay_page(project, file, page, result)
        hint(f"wrote {page}")
    hint(f"replayed {result.seconds:.2f} s of robot time")
    if trace is not None and result.starts > 1:
        hint(f"The script starts the robot program {result.starts} times: the trace is that of the last start.")
    if result.failure is not None:
        click.secho(f"then {result.failure}", fg="red")
    if result.unrepeatable:
        hint(explain_unrepeatable(result.unrepeatable))
    if result.difference is not None:
        where = result.difference
        color = None if result.unrepeatable else "red"
        click.secho(f"The trace differs from the recorded one, first at {where.now:.2f} s:", fg=color)
        click.echo(f"  {where.path} was {json.dumps(where.recorded)}, is {json.dumps(where.replayed)}")
    elif result.equal:
        hint("The trace equals the recorded one. It has the values of hal_data, and not those of NetworkTables.")
    elif result.equal is not None:
        click.echo("The trace differs from the recorded one.")
    # A difference may come from devices that do not repeat: then it is no failure of this robot program.
    differs = not result.unrepeatable and (result.difference is not None or result.equal is False)
    sys.exit(1 if result.failure is not None or differs else 0)
