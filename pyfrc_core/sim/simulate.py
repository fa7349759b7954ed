"""`pyfrc sim`: a simulation, its front end, and what is kept of it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ..errors import UsageError
from ..interruption import ending_like_ctrl_c
from ..project import Project
from ..runtime.scripts.script import load_script
from .c_exit import calling_at_c_exit
from .engine.extensions import WINDOW
from .engine.options import SimOptions
from .engine.robot_side.network import NT4_PORT
from .engine.simulation import Simulation
from .engine.watch import watching
from .output_files import KeptFiles
from .ui.choose import default_name, window
from .ui.headless import Headless, HeadlessMode


@dataclass(frozen=True)
class SimRequest:
    """What the user asks for.

    :param ui: the front end; None: a window, where there can be one
    :param mode: what a headless simulation puts the robot through
    :param seconds: for how long, in robot time; likewise `start_at`
    :param speed: robot seconds a second; None: real time, or as fast as it goes where nobody watches
    :param nt_port: None: the usual one where somebody may look; 0: none
    :param quiet: say only what the robot prints, and what is wrong
    """

    ui: str | None = None
    mode: HeadlessMode | None = None
    seconds: float | None = None
    script: Path | None = None
    start_at: float = 0.0
    speed: float | None = None
    paused: bool = False
    start_position: str | None = None
    watch: bool = False
    record: Path | None = None
    wpilog: Path | None = None
    picture: Path | None = None
    nt_port: int | None = None
    extensions: tuple[str, ...] = ()
    quiet: bool = False


def simulate(project: Project, request: SimRequest, say: Callable[[str], object]) -> int:
    """Simulate the project's robot as the user asks; answers the exit code.

    :param say: prints
    """
    ui = request.ui
    if ui is None:
        ui, why = default_name()
        if why and not request.quiet:
            say(f"No window: {why}. This is --ui none.\n")
    if request.mode is not None and ui != "none":
        raise UsageError("--mode is for simulations without a window", remedy="Add --ui none.")
    headless = Headless(say, request.mode, request.seconds, request.watch, request.quiet) if ui == "none" else None
    front_end = headless or window(ui)
    # Nobody watches what ends by itself.
    unattended = headless is not None and any(
        each is not None for each in (request.mode, request.seconds, request.script)
    )
    port = request.nt_port if request.nt_port is not None else 0 if unattended else NT4_PORT
    options = SimOptions(
        speed=request.speed if request.speed is not None else 0.0 if unattended else 1.0,
        paused=request.paused or headless is not None,
        script=None if request.script is None else load_script(request.script),
        start_at=request.start_at,
        run_until=request.seconds,
        recording=headless is None or request.record is not None or request.watch,
        nt_port=port or None,
        wpilog=request.wpilog,
        extensions=(*request.extensions, WINDOW) if ui == "wpilib" else request.extensions,
        start_position=request.start_position,
    )
    simulation = Simulation(project, options)
    kept = KeptFiles(request.record, request.wpilog, request.picture)
    with ExitStack() as closing:
        interruption = closing.enter_context(ending_like_ctrl_c())
        if ui == "tk":
            simulation.echo = partial(_echo, say)
            closing.enter_context(calling_at_c_exit(partial(_end_without_display, simulation, kept, say)))
        if request.watch:
            closing.enter_context(watching(simulation, front_end.saved))
        try:
            code = front_end.run(simulation)
        except KeyboardInterrupt:  # in the terminal: another way to close a window
            code = 0
        finally:  # also when the terminal has gone, and nothing can be said any more
            interruption.finish()
            simulation.close()
            written = kept.write(simulation)
    with suppress(OSError):  # the terminal has gone
        for file in () if request.quiet else written:
            say(f"wrote {file}\n")
    return code


def _echo(say: Callable[[str], object], text: str) -> None:
    try:
        say(text)
    except UnicodeEncodeError:  # a terminal without this letter
        say(text.encode("ascii", "backslashreplace").decode())
    except OSError:  # the terminal has gone
        pass


def _end_without_display(simulation: Simulation, kept: KeptFiles, say: Callable[[str], object]) -> None:
    """Write the files of a simulation whose window's display has gone, and end. Nothing can be drawn any more."""
    from ..runtime.own_process import exit_now

    with suppress(KeyboardInterrupt):
        simulation.close()
    problem = "error: the display has gone, and the window with it"
    try:
        written = kept.write(simulation)
    except Exception as wrong:
        written, problem = [], f"{problem}. {wrong}"
    with suppress(OSError):
        for file in written:
            _echo(say, f"wrote {file}\n")
        sys.stdout.flush()
        sys.stderr.write(f"{problem}\n")
        sys.stderr.flush()
    exit_now(2)


def draw_script(project: Project, script: Path, picture: Path, until: float | None = None) -> None:
    """Draw the way that the robot drives when it is told what a script says.

    :param until: an earlier end, in seconds of robot time
    """
    from .ui.picture import draw_picture, see_that_pictures_can_be_drawn

    see_that_pictures_can_be_drawn(picture)
    options = SimOptions(speed=0, paused=True, script=load_script(script), recording=False)
    simulation = Simulation(project, options)
    headless = Headless(lambda text: None, seconds=until)
    headless.run(simulation)
    if simulation.snapshot is not None:
        draw_picture(simulation.snapshot.scene, picture)
