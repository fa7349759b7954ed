"""`pyfrc sim`: a simulation, its front end, and the files that it writes."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, suppress
from functools import partial
from pathlib import Path

from ..disk_space import check_disk_space
from ..errors import UsageError
from ..interruption import interruption
from ..project import Project
from ..runtime.scripts.inputs_file import load_inputs, remarks
from ..runtime.scripts.script import trace_beside
from ..shell import quoted
from .engine.options import NT4_PORT, SimOptions
from .engine.simulation import Simulation
from .engine.watch import watching
from .log_report import LogReport
from .log_run import LogRun, log_run
from .page_file import PageFile, place_in
from .ui.choose import FRONT_ENDS, FrontEndKind, SimRequest, default_name, make_front_end

__all__ = ["OutputFiles", "SimRequest", "simulate"]


def simulate(project: Project, request: SimRequest, say: Callable[[str], object]) -> int:
    """Simulate the project's robot, and return the exit code.

    :param say: prints
    """
    ui = _front_end_name(request, say)
    kind = FRONT_ENDS[ui]
    _check(request, kind)
    front_end = make_front_end(ui, request, say)
    share = None if request.tolerance is None else request.tolerance / 100
    log = None
    if request.log is not None:
        log = log_run(project, request.log, share, request.inputs, request.ignored, request.sensors or "log")
    options = _options(request, kind, log)
    for remark in () if options.script is None else remarks(options.script):
        say(f"{remark}\n")
    simulation = Simulation(project, options, None if log is None else log.run)
    page = None if request.page is None else PageFile(request.page, _what(project, request))
    files = OutputFiles(request.record, request.wpilog, page)
    with ExitStack() as closing:
        if not kind.prints:
            simulation.echo = partial(_echo, say)
        if request.watch:
            closing.enter_context(watching(simulation, front_end.saved))
        if page is not None:
            page.follow(simulation, front_end if kind.shows_network else None)
        reported = None if kind.shows_network else log
        report = None if reported is None else LogReport(simulation, reported, request.verbose)
        try:
            code = front_end.run(simulation)
        except KeyboardInterrupt:  # in the terminal: another way to close a window
            code = 0
        finally:  # also when the terminal has gone, and nothing can be printed
            interruption.finish()
            simulation.close()
            written = files.write(simulation)
    with suppress(OSError):  # the terminal has gone
        for line in () if report is None else report.lines():
            say(f"{line}\n")
        for file in () if request.quiet else written:
            say(f"wrote {file}\n")
    return code


def _check(request: SimRequest, kind: FrontEndKind) -> None:
    """:raises UsageError: when the options contradict each other"""
    if request.mode is not None and kind.interactive:
        raise UsageError("--mode is for simulations without a window", remedy="Add --ui none.")
    if request.opmodes and request.mode is None and not kind.interactive:
        raise UsageError("without a window, --opmode needs --mode", remedy="Add --mode auto, --mode teleop, ...")
    if not kind.is_served and request.is_for_page:
        raise UsageError("--share, --port and --allow-host are for the simulator in a browser", remedy="Add --ui web.")
    if request.log is None and any((request.tolerance is not None, request.inputs, request.ignored, request.sensors)):
        raise UsageError("--tolerance, --input, --ignore and --sensors are for a log", remedy="Add --log FILE.")
    if request.log is not None and request.script is not None:
        raise UsageError(
            "--log has all inputs",
            remedy="To change them, such as by a sensor that freezes: --log FILE --record NEW.jsonl writes them as a "
            "script, and --script NEW.jsonl plays what you have changed there.",
        )
    if request.log is not None and any((request.mode, request.opmodes)):
        given = " and ".join(
            option for option, is_given in (("--mode", request.mode), ("--opmode", request.opmodes)) if is_given
        )
        raise UsageError("--log has the modes and all inputs", remedy=f"Leave out {given}.")
    if not kind.is_served and request.share is not None and not _network_port(request, kind):
        raise UsageError(
            "without a page, --share drive shares NetworkTables, and these are not served here",
            remedy=f"Add --nt-port {NT4_PORT}.",
        )


def _is_unattended(request: SimRequest, kind: FrontEndKind) -> bool:
    """Return whether the simulation ends by itself, and no one drives."""
    ends_by_itself = any(each is not None for each in (request.mode, request.seconds, request.script, request.log))
    return not kind.interactive and ends_by_itself


def _network_port(request: SimRequest, kind: FrontEndKind) -> int:
    """Return the port of NetworkTables; 0: they are not served."""
    if request.nt_port is not None:
        return request.nt_port
    return 0 if _is_unattended(request, kind) else NT4_PORT


def _options(request: SimRequest, kind: FrontEndKind, log: LogRun | None) -> SimOptions:
    return SimOptions(
        speed=request.speed if request.speed is not None else 0.0 if _is_unattended(request, kind) else 1.0,
        paused=request.paused or not kind.interactive or _is_shown_whole(request),
        script=log.script if log is not None else None if request.script is None else load_inputs(request.script),
        start_at=log.end if log is not None and kind.interactive and _is_shown_whole(request) else request.start_at,
        run_until=request.seconds,
        recording=kind.interactive or request.watch or any((request.record, request.page, request.log)),
        nt_port=_network_port(request, kind) or None,
        nt_shared=request.share == "drive",
        wpilog=request.wpilog,
        extensions=(*request.extensions, *kind.extensions),
        start_position=request.start_position,
        opmodes=request.opmodes,
        network_values=kind.shows_network or request.page is not None or log is not None,
    )


def _is_shown_whole(request: SimRequest) -> bool:
    """Return whether a log is to be replayed to its end at once, so that all of it can be looked at."""
    return request.log is not None and request.seconds is None and request.speed is None and not request.start_at


def _front_end_name(request: SimRequest, say: Callable[[str], object]) -> str:
    if request.ui is not None:
        return request.ui
    if request.mode is not None:  # possible without a person only
        return "none"
    if request.is_for_page or request.share is not None:
        return "web"
    name, why = default_name()
    if why and not request.quiet:
        say(f"No page: {why}. This is --ui none.\n")
    return name


def _what(project: Project, request: SimRequest) -> str:
    """Return the command for the readers of a page: that part of it which changes what the robot does."""
    parts = ["pyfrc sim"]
    if request.mode is not None:
        parts.append(f"--mode {request.mode}")
    parts += [f"--opmode {quoted(name)}" for name in request.opmodes]
    if request.script is not None:
        parts.append(f"--script {place_in(project, request.script)}")
    if request.log is not None:
        parts.append(f"--log {place_in(project, request.log)}")
    if request.start_position is not None:
        parts.append(f"--start {request.start_position}")
    return " ".join(parts)


def _echo(say: Callable[[str], object], text: str) -> None:
    with suppress(OSError):  # the terminal has gone
        say(text)


class OutputFiles:
    """The files to write."""

    def __init__(self, record: Path | None, wpilog: Path | None, page: PageFile | None = None) -> None:
        self._record, self._wpilog, self._page = record, wpilog, page
        self._former_log = _stamp(wpilog)

    def write(self, simulation: Simulation) -> list[Path]:
        """Write the files, if the robot has started at all.

        :returns: every file that was written, including the data log of the robot's process
        :raises UsageError: when the disk was full
        """
        paged = [self._page.file] if self._page is not None and self._page.write(simulation) else []
        if simulation.snapshot is None:
            return paged
        scripts = [] if self._record is None else simulation.save_all(self._record)
        traces = [trace for trace in map(trace_beside, scripts) if trace.is_file()]
        written = sorted([*scripts, *traces])
        if self._wpilog is not None and _stamp(self._wpilog) != self._former_log:
            if why := check_disk_space(self._wpilog):
                raise UsageError(f"{self._wpilog} is not complete: {why}", remedy="Make room on the disk.")
            written.append(self._wpilog)
        return written + paged


def _stamp(file: Path | None) -> tuple[int, int] | None:
    """Return what changes when a file is written."""
    if file is None or not file.is_file():
        return None
    status = file.stat()
    return status.st_mtime_ns, status.st_size
