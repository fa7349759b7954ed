"""The command `pyfrc coverage`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from .file_options import WrittenDirectory, WrittenFile
from .shared_options import fail_under_option
from .verbosity import verbosity
from .wrapping import WRAPPING, wrapped_command


@click.command("coverage", context_settings=WRAPPING)
@click.option("--html", metavar="DIR", type=WrittenDirectory(), help="Also write the report as web pages.")
@click.option("--xml", metavar="FILE", type=WrittenFile(), help="Also write it as XML, for GitLab or Jenkins.")
@click.option(
    "--json", "as_json", metavar="FILE", type=WrittenFile(), help="Also write it as JSON, for other programs."
)
@fail_under_option
@click.argument("command_line", metavar="COMMAND [OPTIONS]...", nargs=-1, required=True, type=click.UNPROCESSED)
@click.pass_context
def command(
    context: click.Context,
    html: Path | None,
    xml: Path | None,
    as_json: Path | None,
    fail_under: float | None,
    command_line: tuple[str, ...],
) -> None:
    """Measure which lines of the robot project run in another command: test, sim, fuzz or replay.

    Write this command's options before the other command's name: pyfrc coverage --html htmlcov test -j 2

    \b
    Exit codes: the other command's, if it failed; else
    1 too little is covered, 2 wrong usage.
    """
    wrapped = wrapped_command(context, command_line)
    from pyfrc_core.measure.coverage import CoverageOptions, measuring

    options = CoverageOptions(
        enabled=True, html=html, xml=xml, json=as_json, fail_under=fail_under, quiet=verbosity().quiet
    )
    with measuring(wrapped.project, options) as measured:
        status = wrapped.run()
    sys.exit(status or measured.status)
