"""The table of front ends, and which of them shows a simulation.

A front end's module is imported when it is chosen, since most of them need libraries that may be missing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from ...browser import is_ci, why_no_browser
from ...display import GET_TKINTER, WITHOUT_DISPLAY, has_display, has_terminal
from ...errors import UsageError
from ..engine.extensions import WINDOW
from ..engine.output_log import OutputCursor
from ..engine.simulation import Simulation
from . import FrontEnd
from .headless import Headless, HeadlessMode


@dataclass(frozen=True)
class FrontEndOptions:
    """What the user asks of a front end.

    :param say: prints to the terminal
    :param mode: what a front end without a person puts the robot through
    :param seconds: for how long, in robot time
    :param watching: whether saved files bring new code
    :param quiet: print only the robot's output and what is wrong
    :param share: what clients on the network may do, if they are served
    :param port: where to serve a page; 0: at any free port
    :param allowed_hosts: where else browsers find a page, through a forwarded port
    """

    say: Callable[[str], object]
    mode: HeadlessMode | None = None
    seconds: float | None = None
    watching: bool = False
    quiet: bool = False
    share: Literal["view", "drive"] | None = None
    port: int = 0
    allowed_hosts: tuple[str, ...] = ()


@dataclass(frozen=True)
class FrontEndKind:
    """A front end that can be chosen by its name.

    :param make: makes it
    :param interactive: whether a person looks at it and drives
    :param needs_display: whether it opens a window
    :param opens_display: whether this process opens the window, and ends when the display goes away
    :param prints: whether it prints the robot's output to the terminal itself; otherwise the command does
    :param extensions: the simulation extensions that it needs in the robot's process
    :param shows_network: whether it shows the values of NetworkTables
    :param is_served: whether it is a page, which can be shared with the network
    """

    make: Callable[[FrontEndOptions], FrontEnd]
    interactive: bool = True
    needs_display: bool = False
    opens_display: bool = False
    prints: bool = False
    extensions: tuple[str, ...] = ()
    shows_network: bool = False
    is_served: bool = False


def _make_tk(options: FrontEndOptions) -> FrontEnd:
    try:
        from .tk import TkFrontEnd
    except ImportError as missing:
        if missing.name not in ("tkinter", "_tkinter"):
            raise
        raise UsageError("--ui tk needs tkinter, which this Python does not have", remedy=GET_TKINTER) from None
    return TkFrontEnd()


def _make_web(options: FrontEndOptions) -> FrontEnd:
    from .web.front_end import WebFrontEnd
    from .web.server import WebOptions

    served = WebOptions(options.share, options.port, options.allowed_hosts, watching=options.watching)
    return WebFrontEnd(options.say, served, options.quiet)


def _make_wpilib(options: FrontEndOptions) -> FrontEnd:
    return WpilibWindow()


def _make_headless(options: FrontEndOptions) -> FrontEnd:
    return Headless(options.say, options.mode, options.seconds, options.watching, options.quiet)


FRONT_ENDS: dict[str, FrontEndKind] = {
    "web": FrontEndKind(_make_web, shows_network=True, is_served=True),
    "tk": FrontEndKind(_make_tk, needs_display=True, opens_display=True),
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


def make_front_end(name: str, options: FrontEndOptions) -> FrontEnd:
    """Return the front end of this name in `FRONT_ENDS`.

    :raises UsageError: when it cannot work here, saying what to do
    """
    kind = FRONT_ENDS[name]
    if kind.needs_display and not has_display():
        raise UsageError(
            f"--ui {name} needs a display, and there is none",
            remedy=WITHOUT_DISPLAY,
        )
    return kind.make(options)


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
        sys.stdout.write(f"failed at {failure.time:.2f} s: {failure.headline}\n")
        return failure.exit_code

    @staticmethod
    def _print(output: OutputCursor) -> None:
        sys.stdout.write(output.read())
        sys.stdout.flush()
