"""`pyfrc view`."""

from __future__ import annotations

import sys
from functools import partial
from typing import Any

import click

from pyfrc_core.processes.loading import loading

from .file_options import ReadPath, check_outputs
from .shared_options import allow_host_option, page_option, port_option
from .verbosity import verbosity

#: The value of ``--robot`` without an address; it can be none.
_PROJECTS_ROBOT = "the project's"


def _address(context: click.Context, option: click.Parameter, value: str | None) -> str | None:
    """Return the address; empty: the project's robot."""
    if value is not None and not value.strip():
        raise click.BadParameter("the address is empty.", context, option)
    return "" if value == _PROJECTS_ROBOT else value


@click.command("view")
@click.option(
    "--align",
    type=click.Choice(["enabled", "match", "start"]),
    help="What further logs have at the same time as the first one: the first enabling, the match's beginning, or the "
    "beginning of the log. Default: enabled; a driver station's log is put on the time line of the robot's.",
)
@click.option(
    "--offset",
    "offsets",
    type=float,
    multiple=True,
    metavar="S",
    help="Show a further log this many seconds later than its own time says; once for each of them, in their order.",
)
@page_option("the log", "match.html", ", and show nothing")
@click.option(
    "--share",
    type=click.Choice(["view"]),
    is_flag=False,
    flag_value="view",
    help="Let other computers of the network open the page, too.",
)
@port_option
@allow_host_option
@click.option(
    "--robot",
    is_flag=False,
    flag_value=_PROJECTS_ROBOT,
    callback=_address,
    metavar="[ADDRESS]",
    help="Show a robot, live, instead of logs: a team's number or an address. Default: the project's robot, and a "
    "simulation on this computer.",
)
@click.argument("files", nargs=-1, metavar="[FILE]...", type=ReadPath())
def command(**request: Any) -> None:
    """Look at logs of a robot, or at a robot, on a page in your browser: values, plots, field, console, timeline.

    A log is a .wpilog of WPILib, AdvantageKit or PyKit (also .wpilogxz and .rlog), a .dslog or .dsevents of the driver
    station, or a recording or trace of pyfrc (.jsonl). The driver station's log of a match is shown on the time line of
    the robot's, also of a directory with both; you can compare other logs with the first one. A robot is never enabled,
    and its values are set only after you have switched that on.

    \b
    Exit codes: 0 all went well, 1 a file is no log that can be read, 2 wrong usage.
    """
    with loading(verbosity().quiet):
        from pyfrc_core.sim.view import ViewRequest, project_or_none, view
    check_outputs(click.get_current_context(), project_or_none())
    sys.exit(view(ViewRequest(**request, quiet=verbosity().quiet), partial(click.echo, nl=False)))
