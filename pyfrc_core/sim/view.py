"""`pyfrc view`: logs on the page, or a robot, without a robot program."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Literal

from ..errors import ProjectError, UsageError
from ..interruption import interruption
from ..log_formats import LOGS
from ..project import MAIN_FILE, Project, find_project, projects_below
from ..shell import quoted
from ..wording import counted
from .engine.field import field_of
from .engine.past_run import PastRun
from .engine.source import Source
from .logs import OpenedLog, open_log
from .logs.align import Align, offset_of
from .logs.columns import LogHistory
from .logs.source import LogSource
from .logs.station import Alignment, align, join
from .page_file import PageFile
from .what_if import WhatIf

#: The size of logs that take longer to read than a person waits without a word, in bytes.
_LARGE = 100 << 20
#: The most values in one page: about 100 MB in the browser.
_MOST_ON_PAGE = 5_000_000
#: Prints to the terminal.
Say = Callable[[str], object]


@dataclass(frozen=True)
class ViewRequest:
    """The options of the command.

    :param files: the logs, or a directory of one match; the first one is shown, with the driver station's that fit to
        it; the others are its branches
    :param robot: the robot that is shown instead: a team's number or an address; empty: the project's
    :param align: by what the others are aligned with the first one, also those of the driver station; None: these are
        put on its time line, and others are aligned by the first enabling
    :param offsets: what is added to the times of the others, in seconds; further ones are aligned
    :param page: where to write the log as a page, instead of serving it
    """

    files: tuple[Path, ...] = ()
    robot: str | None = None
    align: Align | None = None
    offsets: tuple[float, ...] = ()
    page: Path | None = None
    quiet: bool = False
    share: Literal["view", "drive"] | None = None
    port: int | None = None
    allow_host: tuple[str, ...] = ()


def view(request: ViewRequest, say: Say) -> int:
    """Show logs or a robot on the page until Ctrl-C, or write logs as one file, and return the exit code.

    :raises LogError: when one of the logs cannot be read
    :raises UsageError: when the options contradict each other
    """
    if request.robot is not None:
        if request.files or request.offsets or request.page is not None:
            raise UsageError("--robot shows a robot, and no logs", remedy="Drop a log on its page to compare them.")
        return _serve(_robot(request, say), request, say)
    if not request.files:
        raise UsageError("nothing to show", remedy="Name a log: pyfrc view FILE. For a robot: pyfrc view --robot")
    if len(request.offsets) >= len(request.files):
        raise UsageError(
            f"--offset is given {counted(len(request.offsets), 'time')}, for "
            f"{counted(len(request.files) - 1, 'log')} beside the first one",
            remedy="Give it once for each of them, in their order.",
        )
    if request.page is not None and any((request.share, request.port, request.allow_host)):
        raise UsageError(
            "--page writes a file, and serves no page", remedy="Leave out --share, --port and --allow-host, or --page."
        )
    project = project_or_none() or _no_project()
    height = field_of(project).height
    files = _files(request.files)
    opened = [_opened(*each, height, request, say) for each in zip(files, _names(files), strict=True)]
    if not request.offsets:  # the robot's log first, and the driver station's on its time line
        opened.sort(key=lambda each: each.is_station)
    first, branches = _aligned(request, opened, height, say)
    what_if = WhatIf(project, first.file, say)
    elsewhere = None if project.main_file.is_file() else _project_elsewhere()
    source = LogSource(
        project,
        first,
        branches,
        what_if.start if project.main_file.is_file() else None if elsewhere is None else partial(_refuse, elsewhere),
    )
    if request.page is not None:
        _check_size(first.run, *source.branches)
        page = PageFile(request.page, f"pyfrc view {first.run.name}")
        page.follow(source)
        page.write(source)
        if not request.quiet:
            say(f"wrote {request.page}\n")
        return 0
    if elsewhere is not None and not request.quiet:
        say(f"{elsewhere}\n")
    try:
        return _serve(source, request, say)
    finally:
        what_if.close()


def _robot(request: ViewRequest, say: Say) -> Source:
    """Return the robot that is shown."""
    from .live.addresses import addresses_for
    from .live.robot import LiveRobot

    project = project_or_none()
    where = addresses_for(request.robot or None, project)
    return LiveRobot(project or _no_project(), where, tell=(lambda text: None) if request.quiet else say)


def _serve(source: Source, request: ViewRequest, say: Say) -> int:
    from .ui.web.front_end import WebFrontEnd
    from .ui.web.server import WebOptions

    front_end = WebFrontEnd(say, WebOptions(request.share, request.port or 0, request.allow_host), request.quiet)
    try:
        with suppress(KeyboardInterrupt):
            return front_end.run(source)
    finally:
        interruption.finish()
    return 0


def _check_size(*runs: PastRun) -> None:
    """:raises UsageError: when a page with all values of these runs would be too large"""
    histories = [history for run in runs for history in run.histories.values() if isinstance(history, LogHistory)]
    if (count := sum(history.count for history in histories)) > _MOST_ON_PAGE:
        raise UsageError(
            f"--page: these logs have {count:,} values; a page has at most {_MOST_ON_PAGE:,}",
            remedy="Leave out --page, or some of the logs.",
        )


def project_or_none() -> Project | None:
    """Return the project of the current directory, if there is one."""
    try:
        return find_project()
    except ProjectError:
        return None


def _project_elsewhere() -> ProjectError | None:
    """Return why no code can be run with a log, if there is a project below the current directory."""
    if not (below := projects_below(Path.cwd())):
        return None
    found = below[0].as_posix()
    return ProjectError(
        f"there is no {MAIN_FILE} here, but there is one in ./{found}",
        remedy='"What would my code have done?" needs it. To have it, end this, and start pyfrc view there: '
        f"cd {quoted(found)}",
    )


def _refuse(error: ProjectError) -> str:
    raise error


def _no_project() -> Project:
    """Return what stands for a project where there is none: it keeps the page's arrangement."""
    import platformdirs

    root = platformdirs.user_data_path("pyfrc", appauthor=False) / "view"
    with suppress(OSError):  # then nothing is kept
        root.mkdir(parents=True, exist_ok=True)
    return Project(root / MAIN_FILE)


def _files(given: Sequence[Path]) -> list[Path]:
    """Return the logs that are given, and those in directories.

    :raises UsageError: when a directory has no log, or the logs of several matches
    """
    found: list[Path] = []
    for path in given:
        if not path.is_dir():
            found.append(path)
            continue
        logs = sorted(file for file in path.iterdir() if file.suffix.lower() in LOGS and file.is_file())
        if not logs:
            raise UsageError(f"{path} has no log", remedy=f"Logs are {', '.join(LOGS)}.")
        robots = [file.name for file in logs if not file.suffix.lower().startswith(".ds")]
        if len(robots) > 1:
            raise UsageError(
                f"{path} has {len(robots)} logs of a robot, and a directory is shown as one match",
                remedy=f"Name what to show, such as {path / robots[0]}",
            )
        found += (file for file in logs if file.suffix != ".dsevents" or not file.with_suffix(".dslog").is_file())
    return found


def _names(files: Sequence[Path]) -> list[str]:
    """Return the names of files; of those with the same name, with as much of the path as tells them apart."""
    paths = [Path(os.path.abspath(file)).parts for file in files]  # noqa: PTH100 - links keep their names
    found = []
    for own in paths:
        others = [each for each in paths if each != own]
        needed = (count for count in range(1, len(own)) if all(each[-count:] != own[-count:] for each in others))
        found.append(Path(*own[-next(needed, len(own)) :]).as_posix())
    return found


def _opened(file: Path, name: str, height: float, request: ViewRequest, say: Say) -> OpenedLog:
    if not request.quiet and file.is_file() and (size := file.stat().st_size) > _LARGE:
        say(f"Reading {file} ({size >> 20} MB)...\n")
    opened = open_log(file, height, name)
    if opened.problem:
        say(f"{file}: {opened.problem}.\n")
    return opened


def _aligned(
    request: ViewRequest, opened: list[OpenedLog], height: float, say: Say
) -> tuple[OpenedLog, tuple[PastRun, ...]]:
    """Return the log that is shown, with those of the driver station that fit to it, and the others as branches."""
    first, *others = opened
    branches = []
    for number, log in enumerate(others):
        given = request.offsets[number] if number < len(request.offsets) else None
        if log.is_station and first.read is not None and not first.is_station and request.align is None:
            alignment = align(first, log) if given is None else Alignment(given, "you have given --offset")
            if alignment.offset is not None:
                first = join(first, log, alignment, height)
                if not request.quiet:
                    say(f"{first.run.happened[0].text}\n")
                continue
            say(
                f"{log.run.name} is not put on the time line of {first.run.name}: {alignment.how}. It is a branch that "
                "begins with it. If you know how many seconds later it began: --offset S\n"
            )
            given = 0.0
        offset = given
        if offset is None:
            offset = offset_of(log.run.histories["network"], first.run.histories["network"], request.align or "enabled")
        if offset is None:
            say(
                f"{log.run.name} begins together with {first.run.name}: one of them does not say when it was enabled.\n"
            )
        branches.append(replace(log.run, offset=offset or 0.0))
    return first, tuple(branches)
