"""`pyfrc profile`: measure how long the robot's functions take, in every process and thread."""

from __future__ import annotations

import cProfile
import json
import os
import pstats
import tempfile
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
from ..runtime.patch_table import PatchTable
from ..text_files import check_writable, write_whole
from .figures import Figures, added_up
from .flame import require_pyinstrument, write_flame
from .processes import announced, is_announced
from .profile_report import as_json, as_text
from .stopwatch_cost import measured_cost


@dataclass(frozen=True)
class ProfileOptions:
    """The reports to write besides the printed one.

    :param pstats: a file in the format of Python's `pstats`
    :param html: a web page with a flame graph
    :param json: all measurements
    :param top: how many functions and lines to print
    :param quiet: print the report, but not the paths of the others
    """

    pstats: Path | None = None
    html: Path | None = None
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
            self._profile.enable()
            try:
                return function(*args, **kwargs)
            finally:
                self._profile.disable()
                self._on = False

        try:
            return wraps(function)(profiled)
        except (AttributeError, TypeError):  # a callable object that is not a function
            return profiled

    def clear(self) -> None:
        """Delete all measurements, in a fork."""
        self._profile = cProfile.Profile()
        self._on = False

    def save(self, file: Path) -> None:
        """Write the calls to a file, if there were any."""
        self._profile.create_stats()
        if self._profile.stats:
            self._profile.dump_stats(file)


def begin(settings: dict[str, Any]) -> Callable[[], None]:
    """Start measuring in this process; return a function that saves the result. A fork continues to measure."""
    from .sampler import Sampler
    from .stopwatch import Stopwatch
    from .user_functions import UserFunctions

    figures, files = Figures(), RobotFiles(Path(settings["root"]))
    stopwatch = Stopwatch(figures, files)
    sampler = Sampler(figures, files, settings["stacks"])
    calls = _CallProfile() if settings["calls"] else None
    table, numbers = PatchTable(), count()
    UserFunctions(stopwatch, files, calls.wrap if calls is not None else lambda function: function).install(table)
    sampler.sample_runs(table)

    def in_fork() -> None:
        figures.clear()
        stopwatch.clear()
        sampler.clear()
        if calls is not None:
            calls.clear()

    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=in_fork)

    def save() -> None:
        sampler.stop()
        name = f"{os.getpid()}-{next(numbers)}"
        figures.save(Path(settings["directory"], f"{name}.figures"))
        figures.clear()
        if calls is not None:
            calls.save(Path(settings["directory"], f"{name}.pstats"))
            calls.clear()
        table.undo()

    return save


@contextmanager
def profiling(project: Project, options: ProfileOptions, command: str) -> Iterator[None]:
    """Measure until the context ends, then write the reports, also after an error.

    :param command: the title of the reports
    """
    if is_announced("profile"):
        raise UsageError("a profile is already being measured")
    if options.html is not None:
        require_pyinstrument()
    for option, file in (("--outfile", options.pstats), ("--html", options.html), ("--json", options.json)):
        check_writable(option, file)
    # The directory for the figures of each process, until they are added up.
    with tempfile.TemporaryDirectory(prefix="pyfrc-profile-") as directory:
        settings = {
            "root": str(project.root),
            "directory": directory,
            "stacks": options.html is not None,
            "calls": options.pstats is not None,
        }
        try:
            with announced("profile", settings):
                yield
        finally:
            _report(Path(directory), options, command)


def _report(directory: Path, options: ProfileOptions, command: str) -> None:
    figures = added_up(sorted(directory.glob("*.figures")))
    profiled_calls = _add_up_calls(sorted(directory.glob("*.pstats")), options.pstats)
    cost = measured_cost(figures, profiled_calls)

    def print_path(text: str) -> None:
        if not options.quiet:
            print(text)

    print()
    print(as_text(figures, cost, options.top))
    if options.pstats is not None and profiled_calls:
        print_path(f"profile for pstats: {options.pstats}")
    if options.html is not None:
        write_flame(figures, options.html, command)
        print_path(f"profile as a web page: {options.html}")
    if options.json is not None:
        write_whole(options.json, [json.dumps(as_json(figures, cost, command), indent=1), "\n"])
        print_path(f"profile as JSON: {options.json}")


def _add_up_calls(files: list[Path], wanted: Path | None) -> int:
    """Write the `pstats` of all processes to one file; return the number of calls in it."""
    if wanted is None or not files:
        return 0
    total = pstats.Stats(*map(str, files))
    wanted.parent.mkdir(parents=True, exist_ok=True)
    total.dump_stats(wanted)
    return total.total_calls  # type: ignore[attr-defined,no-any-return]
