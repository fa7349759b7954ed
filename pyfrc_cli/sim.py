"""`pyfrc sim`."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import Any

import click

from pyfrc_core.processes.loading import loading

from .file_options import ReadPath, WrittenFile
from .project_options import chosen_project, project_options
from .shared_options import allow_host_option, page_option, port_option
from .verbosity import verbosity


@click.command("sim")
@project_options
@click.option(
    "--ui",
    type=click.Choice(["web", "tk", "wpilib", "none"]),
    help="web: a page in the browser; tk: pyfrc's window; wpilib: WPILib's window; or none. Default: web; none with "
    "--mode, where CI is set, and where there is neither a browser nor a terminal.",
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
@click.option(
    "--seconds",
    type=click.FloatRange(min=0.02),
    metavar="S",
    help="End at this robot time, in seconds; on a page or in a window, pause there.",
)
@click.option(
    "--script", type=ReadPath(), metavar="FILE", help="Replay the inputs of this script, such as one of --record."
)
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
    help="Run to this robot time, in seconds, as fast as possible, and go on from there.",
)
@click.option(
    "--speed",
    type=float,
    metavar="X",
    help="Robot seconds per second; 0: as fast as possible. Default: 1, but 0 with --ui none and an end (--mode, "
    "--seconds, --script or --log).",
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
@page_option("the whole run", "run.html")
@click.option(
    "--nt-port",
    type=click.IntRange(0, 65535),
    metavar="PORT",
    help="The port at which dashboards find NetworkTables; 0: none. Default: 5810, but 0 where that of --speed is 0.",
)
@click.option(
    "--ext",
    "extensions",
    multiple=True,
    metavar="NAME",
    help="Load one of WPILib's simulation extensions, which connect other programs: ds-socket, ws-server, ws-client; "
    "may be repeated.",
)
@click.option(
    "--share",
    type=click.Choice(["view", "drive"]),
    is_flag=False,
    flag_value="view",
    help="Let other computers of the network open the page, too: to look only, or to drive, also with NetworkTables. "
    "Default: to look.",
)
@port_option
@allow_host_option
def command(directory: Path | None, main: Path | None, robot_class: str | None, **request: Any) -> None:
    """Simulate the robot, with its physics, on a page in your browser, and drive it there.

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
