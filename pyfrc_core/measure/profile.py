"""`pyfrc profile`: measure how long the robot's functions take, in every process and thread."""

from __future__ import annotations

import cProfile
import json
import os
import pstats
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from itertools import count
from pathlib import Path
from typing import Any

from ..errors import UsageError
from ..project import Project
from ..project.robot_files import RobotFiles
from ..temporary import temporary_directory
from ..text_files import write_whole
from .figures import Figures, added_up
from .processes import announced, is_announced
from .profile_report import as_json, as_text


@dataclass(frozen=True)
class ProfileOptions:
    """The reports to write besides the printed one.

    :param pstats: a file in the format of Python's `pstats`
    :param json: all measurements
    :param top: how many functions to print
    :param quiet: print the report, but not the paths of the others
    """

    pstats: Path | None = None
    json: Path | None = None
    top: int = 20
    quiet: bool = False


class _CallProfile:
    """Runs `cProfile` around the timed functions of this process, one call at a time, in any thread."""

    def __init__(self) -> None:
        self._profile = cProfile.Profile()
        self._on = False

    def wrap(self, function: Callable[..., object]) -> Callable[..., Any]:
        """Return the function with profiling, for calls from outside the other wrapped functions."""

        def profiled(*args: object, **kwargs: object) -> Any:
            __tracebackhide__ = True
            if self._on:
                return function(*args, **kwargs)
            self._on = True
            try:
                return self._profile.runcall(function, *args, **kwargs)
            finally:
                self._on = False

        try:
            return wraps(function)(profiled)
        except (AttributeError, TypeError):  # a callable object that is not a function
            return profiled

    def clear(self) -> None:
        """Delete all measurements."""
        self.__init__()  # type: ignore[misc]

    def save(self, file: Path) -> None:
        """Write the calls to a file, if there were any."""
        self._profile.create_stats()
        if self._profile.stats:
            self._profile.dump_stats(file)


def begin(settings: dict[str, Any]) -> Callable[[], None]:
    """Start measuring in this process; return a function that saves the result. A fork continues to measure."""
    from ..patch_table import PatchTable
    from ..runtime.robot import RobotRun
    from .stopwatch import Stopwatch
    from .user_functions import UserFunctions

    figures, calls, files = Figures(), _CallProfile(), RobotFiles(Path(settings["root"]))
    wrap = calls.wrap if settings["calls"] else lambda function: function
    functions = UserFunctions(Stopwatch(figures), files, wrap)
    table, numbers, real_open = PatchTable(), count(), RobotRun.open

    def open_run(run: RobotRun) -> None:
        functions.time_callbacks(table)
        real_open(run)

    def clear() -> None:
        figures.clear()
        calls.clear()

    functions.install(table)
    table.patch(RobotRun, "open", open_run)
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=clear)

    def save() -> None:
        name = Path(settings["directory"], f"{os.getpid()}-{next(numbers)}")
        figures.save(name.with_suffix(".figures"))
        calls.save(name.with_suffix(".pstats"))
        clear()
        table.undo()

    return save


@contextmanager
def profiling(project: Project, options: ProfileOptions, command: str) -> Iterator[None]:
    """Measure until the context ends, then write the reports, also after an error.

    :param command: the title of the reports
    """
    if is_announced("profile"):
        raise UsageError("a profile is already being measured")
    # The directory for the figures of each process, until they are added up.
    with temporary_directory("profile") as directory:
        settings = {
            "root": str(project.root),
            "directory": directory,
            "calls": options.pstats is not None,
        }
        try:
            with announced("profile", settings):
                yield
        finally:
            _report(Path(directory), options, command)


def _report(directory: Path, options: ProfileOptions, command: str) -> None:
    def print_path(text: str) -> None:
        if not options.quiet:
            print(text)

    figures = added_up(sorted(directory.glob("*.figures")))
    print()
    print(as_text(figures, options.top))
    calls = [str(file) for file in sorted(directory.glob("*.pstats"))]
    if options.pstats is not None and calls:
        options.pstats.parent.mkdir(parents=True, exist_ok=True)
        pstats.Stats(*calls).dump_stats(options.pstats)
        print_path(f"profile for pstats: {options.pstats}")
    if options.json is not None:
        write_whole(options.json, [json.dumps(as_json(figures, command), indent=1), "\n"])
        print_path(f"profile as JSON: {options.json}")
