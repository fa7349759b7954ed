"""The table of front ends, and which of them shows a simulation.

A front end's module is imported when it is chosen, since most of them need libraries that may be missing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from ...browser import is_ci, why_no_browser
from ...display import WITHOUT_DISPLAY, has_display, has_terminal
from ...errors import UsageError
from ...processes.loading import loading
from ...season import CURRENT
from ...shell import getting_tkinter
from ..engine.extensions import WINDOW
from ..engine.output_log import OutputCursor
from ..engine.simulation import Simulation
from ..log_run import SensorSource
from . import FrontEnd
from .headless import Headless, HeadlessMode

#: Prints to the terminal.
Say = Callable[[str], object]


@dataclass(frozen=True)
class SimRequest:
    """The options of the command.

    :param ui: the name of the front end; None: the one that the other options need, or that this machine allows
    :param mode: what a headless simulation puts the robot through
    :param opmodes: the names of opmodes to choose, each for its mode
    :param seconds: the end, in robot time; `start_at` likewise
    :param log: the log whose inputs drive the robot, and that is shown beside it
    :param tolerance: how far values of the log may differ, in percent of their range; None: see `log_run`
    :param inputs: entries of NetworkTables that a person set while the log was made
    :param sensors: what moves the sensors that the log has; None: the log
    :param ignored: names of values that are not compared with those of the log
    :param speed: robot seconds per second; None: real time, or as fast as possible when unattended
    :param nt_port: None: the usual port, or none when unattended; 0: none
    :param quiet: print only the robot's output and what is wrong
    :param verbose: name all that differs from a log
    :param share: what clients on the network may do; None: they are not served. Those who may drive get NetworkTables
    :param port: where to serve a page; None: at any free port
    :param allow_host: where else browsers find a page, through a forwarded port
    """

    ui: str | None = None
    mode: HeadlessMode | None = None
    seconds: float | None = None
    script: Path | None = None
    log: Path | None = None
    tolerance: float | None = None
    inputs: tuple[str, ...] = ()
    sensors: SensorSource | None = None
    ignored: tuple[str, ...] = ()
    start_at: float = 0.0
    speed: float | None = None
    paused: bool = False
    start_position: str | None = None
    opmodes: tuple[str, ...] = ()
    watch: bool = False
    record: Path | None = None
    wpilog: Path | None = None
    page: Path | None = None
    nt_port: int | None = None
    extensions: tuple[str, ...] = ()
    quiet: bool = False
    verbose: bool = False
    share: Literal["view", "drive"] | None = None
    port: int | None = None
    allow_host: tuple[str, ...] = ()

    @property
    def is_for_page(self) -> bool:
        """Whether options are given that only a page has."""
        return self.share == "view" or self.port is not None or bool(self.allow_host)


@dataclass(frozen=True)
class FrontEndKind:
    """A front end that can be chosen by its name.

    :param make: makes it
    :param interactive: whether a person looks at it and drives
    :param needs_display: whether it opens a window
    :param prints: whether it prints the robot's output to the terminal itself; otherwise the command does
    :param extensions: the simulation extensions that it needs in the robot's process
    :param shows_network: whether it shows the values of NetworkTables
    :param is_served: whether it is a page, which can be shared with the network
    """

    make: Callable[[SimRequest, Say], FrontEnd]
    interactive: bool = True
    needs_display: bool = False
    prints: bool = False
    extensions: tuple[str, ...] = ()
    shows_network: bool = False
    is_served: bool = False


def _make_tk(request: SimRequest, say: Say) -> FrontEnd:
    try:
        from .tk import TkFrontEnd
    except ImportError as missing:
        if missing.name not in ("tkinter", "_tkinter"):
            raise
        raise UsageError("--ui tk needs tkinter, which this Python does not have", remedy=getting_tkinter()) from None
    return TkFrontEnd()


def _make_web(request: SimRequest, say: Say) -> FrontEnd:
    from .web.front_end import WebFrontEnd
    from .web.server import WebOptions

    options = WebOptions(request.share, request.port or 0, request.allow_host, watching=request.watch)
    return WebFrontEnd(say, options, request.quiet)


def _make_wpilib(request: SimRequest, say: Say) -> FrontEnd:
    if not CURRENT.window_drives:
        say(f"WPILib's window of {CURRENT.year} shows this robot, but cannot enable it. To drive: --ui web\n")
    return WpilibWindow()


def _make_headless(request: SimRequest, say: Say) -> FrontEnd:
    return Headless(say, request.mode, request.seconds, request.watch, request.quiet)


FRONT_ENDS: dict[str, FrontEndKind] = {
    "web": FrontEndKind(_make_web, shows_network=True, is_served=True),
    "tk": FrontEndKind(_make_tk, needs_display=True),
    "wpilib": FrontEndKind(_make_wpilib, needs_display=True, prints=True, extensions=(WINDOW,)),
    "none": FrontEndKind(_make_headless, interactive=False, prints=True),
}


def default_name() -> tuple[str, str]:
    """Return the name of the front end for this machine, and the reason when it is not the page.

    Without a browser the page is served as well: a person can open its address, also through a forwarded port. A
    script or a job would wait for that person forever, so it gets no page.
    """
    if is_ci():
        return "none", "CI is set"
    if (why := why_no_browser()) and not has_terminal():
        return "none", f"{why}, and no terminal"
    return "web", ""


def make_front_end(name: str, request: SimRequest, say: Say) -> FrontEnd:
    """Return the front end of this name in `FRONT_ENDS`.

    :raises UsageError: when it cannot work here, saying what to do
    """
    kind = FRONT_ENDS[name]
    if kind.needs_display and not has_display():
        raise UsageError(
            f"--ui {name} needs a display, and there is none",
            remedy=WITHOUT_DISPLAY,
        )
    with loading(request.quiet):
        return kind.make(request, say)


class WpilibWindow(FrontEnd):
    """Waits for the user to close WPILib's own simulator window (`robotpy-halsim-gui`).

    It runs in the robot's process, which has opened it, and draws the HAL itself.
    """

    def run(self, simulation: Simulation) -> int:
        """Run the simulation, and return the exit code: 1 when the robot has failed."""
        output = simulation.output_cursor()
        with simulation:
            while not simulation.wait_for(lambda: simulation.status.state in ("failed", "closed"), timeout=0.25):
                self._print(output)
            failure = simulation.status.failure
        self._print(output)
        if failure is None:
            return 0
        sys.stdout.write(f"{failure}\n")
        return failure.exit_code

    @staticmethod
    def _print(output: OutputCursor) -> None:
        sys.stdout.write(output.read())
        sys.stdout.flush()
