"""`pyfrc sim`."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import Any

import click

from pyfrc_core.processes.loading import loading

from .file_options import ReadPath, WrittenFile
from .page_options import allow_host_option, port_option
from .project_options import chosen_project, project_options
from .verbosity import verbosity


@click.command("sim", context_settings={"help_option_names": ["-h", "--help"]})
@project_options
@click.option(
    "--ui",
    type=click.Choice(["web", "tk", "wpilib", "none"]),
    help="A page in the browser, pyfrc's window, WPILib's window, or none. Default: web; none with --mode, and in jobs "
    "and scripts.",
)
@click.option(
    "--mode",
    type=click.Choice(["practice", "auto", "teleop", "test", "utility", "disabled"]),
    callback=lambda context, option, mode: "test" if mode == "utility" else mode,
    help="Without a page or a window: the mode that the robot is put through. Utility is 2027's name of test.",
)
@click.option(
    "--opmode",
    "opmodes",
    multiple=True,
    metavar="NAME",
    help="Choose this opmode of a 2027 robot for its mode; may be repeated. Default: the first of each mode.",
)
@click.option("--seconds", type=click.FloatRange(min=0.02), metavar="S", help="End, or pause, at this robot time.")
@click.option("--script", type=ReadPath(), metavar="FILE", help="Replay the inputs of this script.")
@click.option(
    "--log",
    type=ReadPath(),
    metavar="FILE",
    help="Drive today's code with the inputs of this log (.wpilog, or a recording), and show where the two differ.",
)
@click.option(
    "--tolerance",
    type=click.FloatRange(0, 100),
    metavar="PERCENT",
    help="With --log: how far values may differ, in percent of their range. Default: 0 for pyfrc's own recordings, if "
    "all devices repeat exactly; otherwise 5.",
)
@click.option(
    "--input",
    "inputs",
    multiple=True,
    metavar="NAME",
    help="With --log: a person has set this value on a dashboard, such as SmartDashboard/kP; may be repeated.",
)
@click.option(
    "--ignore",
    "ignored",
    multiple=True,
    metavar="NAME",
    help="With --log: do not compare this value, such as led_time; * stands for any text; may be repeated.",
)
@click.option(
    "--sensors",
    type=click.Choice(["log", "physics"]),
    help="With --log: what moves the sensors that the log has. Default: log. With physics, the robot goes on where "
    "changed code drives it.",
)
@click.option(
    "--from",
    "start_at",
    type=click.FloatRange(min=0),
    default=0.0,
    metavar="T",
    help="Replay to this robot time at once, and go on from there.",
)
@click.option(
    "--speed",
    type=float,
    metavar="X",
    help="Robot seconds per second; 0: as fast as possible. Default: 1, or 0 when unattended.",
)
@click.option("--paused", is_flag=True, help="Begin paused.")
@click.option("--start", "start_position", metavar="NAME", help="Start at one of start_positions in sim/config.json.")
@click.option("--watch", is_flag=True, help="When a file is saved, continue with the new code.")
@click.option(
    "--record",
    type=WrittenFile(is_recording=True),
    metavar="FILE",
    help="Write an input script, for pyfrc replay and tests.",
)
@click.option("--wpilog", type=WrittenFile(), metavar="FILE", help="Write a WPILib data log, for AdvantageScope.")
@click.option(
    "--picture", type=WrittenFile(), metavar="FILE", help="Draw the driven path on the field, such as path.png."
)
@click.option(
    "--page",
    type=WrittenFile(),
    metavar="FILE",
    help="Write the whole run as a page, such as run.html, for any browser.",
)
@click.option(
    "--nt-port",
    type=click.IntRange(0, 65535),
    metavar="PORT",
    help="Serve NetworkTables to dashboards here; 0: nowhere. Default: 5810, or 0 when unattended.",
)
@click.option(
    "--ext",
    "extensions",
    multiple=True,
    metavar="NAME",
    help="Load one of WPILib's simulation extensions: ds-socket, ws-server, ws-client; may be repeated.",
)
@click.option(
    "--share",
    type=click.Choice(["view", "drive"]),
    is_flag=False,
    flag_value="view",
    help="Serve the page to the network, too, to look only or to drive; to drive: also NetworkTables.",
)
@port_option
@allow_host_option
def command(directory: Path | None, main: Path | None, robot_class: str | None, **request: Any) -> None:
    """Drive the robot on the desk: simulate it, with its physics, on a page in your browser.

    Where no browser can be opened, pyfrc prints the page's address. With --ui none, --mode, --seconds, --script or
    --log say what to simulate, as fast as it goes; with none of them the robot runs in real time, for dashboards, until
    Ctrl-C.

    \b
    Exit codes: 0 all went well, 1 the robot's code failed, 2 wrong usage.
    """
    project = chosen_project(directory, main, robot_class)
    with loading(verbosity().quiet):
        from pyfrc_core.sim.simulate import SimRequest, simulate
    chosen = verbosity()
    whole = SimRequest(**request, quiet=chosen.quiet, verbose=chosen.verbose)
    sys.exit(simulate(project, whole, partial(click.echo, nl=False)))
