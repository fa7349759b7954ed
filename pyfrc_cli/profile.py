"""The command `pyfrc profile`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from .file_options import WrittenFile
from .verbosity import verbosity
from .wrapping import WRAPPING, wrapped_command


@click.command("profile", context_settings=WRAPPING)
@click.option(
    "-o",
    "--outfile",
    metavar="FILE",
    type=WrittenFile(),
    help="Also time every call, much more slowly, with Python's cProfile, and write its file, which pstats reads.",
)
@click.option(
    "--json", "as_json", metavar="FILE", type=WrittenFile(), help="Write all measurements as JSON, for other programs."
)
@click.option(
    "--top",
    metavar="N",
    type=click.IntRange(min=1),
    default=20,
    show_default=True,
    help="How many functions to print.",
)
@click.argument("command_line", metavar="COMMAND [OPTIONS]...", nargs=-1, required=True, type=click.UNPROCESSED)
@click.pass_context
def command(
    context: click.Context,
    outfile: Path | None,
    as_json: Path | None,
    top: int,
    command_line: tuple[str, ...],
) -> None:
    """Measure how long the robot's functions take in another command: test, sim, fuzz or replay.

    Shows for each function that WPILib, commands2 or magicbot calls how its times are distributed; when and where the
    loop overran its period, and which function caused it. Write this command's options before the other command's name:
    pyfrc profile --json profile.json test -j 1

    \b
    Exit codes: the other command's; 2 wrong usage.
    """
    wrapped = wrapped_command(context, command_line)
    from pyfrc_core.measure.profile import ProfileOptions, profiling

    options = ProfileOptions(outfile, as_json, top, verbosity().quiet)
    with profiling(wrapped.project, options, f"pyfrc {' '.join(command_line)}"):
        status = wrapped.run()
    sys.exit(status)
