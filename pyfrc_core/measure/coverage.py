"""Measure which of the project's own lines and functions run, also in the processes of isolated tests."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import UsageError
from ..project import Project
from ..project.walk import python_files, why_unreadable
from ..temporary import temporary_directory
from ..text_files import write_whole
from ..wording import counted
from .processes import announced, is_announced

if TYPE_CHECKING:
    from coverage import Coverage

__all__ = ["CoverageOptions", "Measured", "begin", "measuring"]


@dataclass(frozen=True)
class CoverageOptions:
    """The reports to write.

    :param fail_under: the lowest percentage that counts as success
    :param quiet: print the report and errors, but not the paths of the other reports
    """

    enabled: bool
    html: Path | None = None
    xml: Path | None = None
    json: Path | None = None
    fail_under: float | None = None
    quiet: bool = False


@dataclass
class Measured:
    """Result of a measurement: `status` is 1 when too little was covered."""

    status: int = 0


def begin(settings: dict[str, Any]) -> Callable[[], None]:
    """Start measuring in this process; return a function that saves the result. A fork continues to measure."""
    from coverage import Coverage

    measurement = Coverage(data_suffix=True, **settings)
    # A process that only waits for others runs no line of the project: no warning is needed.
    measurement.set_option("run:disable_warnings", ["no-data-collected"])
    measurement.start()

    def save() -> None:
        measurement.stop()
        measurement.save()

    return save


@contextmanager
def measuring(project: Project, options: CoverageOptions) -> Iterator[Measured]:
    """Measure until the context ends, then print the reports.

    Lines count in this process, in forked and spawned processes, and in threads. Only the project's own robot code is
    measured, without its tests and without installed packages.
    """
    result = Measured()
    if not options.enabled:
        yield result
        return
    if is_announced("coverage"):
        raise UsageError(
            "coverage is already being measured", remedy="Leave out one of: pyfrc coverage, test --coverage."
        )
    from coverage import Coverage
    from coverage.exceptions import CoverageException

    # The directory for the data of each process, until it is combined; nothing stays in the project.
    with temporary_directory("coverage") as directory:
        settings: dict[str, Any] = {
            "data_file": str(Path(directory) / "data"),
            "source": [str(project.root)],
            "omit": ["*/site-packages/*", *_patterns(project)],
            "config_file": str(project.pyproject) if project.pyproject.is_file() else False,
        }
        try:
            with announced("coverage", settings):
                yield result
            combined = Coverage(**settings)
            combined.combine([directory])
            result.status = _report(combined, options, Path(directory, "report.json"))
        except (CoverageException, ValueError) as error:
            where = project.pyproject.name if "config" in str(error).lower() else None
            raise UsageError(f"coverage: {error}", where=where) from error


def _patterns(project: Project) -> Iterator[str]:
    """Yield coverage's patterns for tests, and for what cannot be read: it would wait for a pipe."""
    names = [f"{tests}{os.sep}*" for tests in project.test_directories]
    names += [str(file) for file in python_files(project.root) if why_unreadable(file)]
    # coverage has no way to write a bracket, which names of directories may have.
    yield from (re.sub(r"[][{}]", "?", name) for name in names)


def _report(combined: Coverage, options: CoverageOptions, as_json: Path) -> int:
    """Print and write the reports; return the exit code.

    :param as_json: where to write coverage.py's JSON, which has more details than the other reports
    """
    from coverage.exceptions import NoDataError

    def print_path(text: str) -> None:
        if not options.quiet:
            print(text)

    print()
    try:
        # A file that cannot be parsed is reported and skipped: the robot may not use it.
        total = combined.report(show_missing=True, ignore_errors=True, file=sys.stdout)
        combined.json_report(outfile=str(as_json), ignore_errors=True)
        text = as_json.read_text("utf-8")
        if unused := never_run(json.loads(text)):
            print(unused)
        if options.html is not None:
            combined.html_report(directory=str(options.html), ignore_errors=True)
            print_path(f"coverage as web pages: {options.html / 'index.html'}")
        if options.xml is not None:
            combined.xml_report(outfile=str(options.xml), ignore_errors=True)
            print_path(f"coverage as XML: {options.xml}")
        if options.json is not None:
            write_whole(options.json, [text])
            print_path(f"coverage as JSON: {options.json}")
    except OSError as error:
        if error.filename is None:  # as of a full disk
            error.filename = str(options.html or options.xml or options.json)
        raise
    except NoDataError:
        print("coverage: no line of the project was run", file=sys.stderr)
        return 1
    if options.fail_under is not None and total < options.fail_under:
        print(f"coverage: {total:.1f} % is less than the required {options.fail_under:g} %", file=sys.stderr)
        return 1
    return 0


def never_run(report: Mapping[str, Any]) -> str:
    """Return the functions that were never run as text: the files with most such lines first, in each file the longest
    functions first. Empty when there are none.

    :param report: coverage.py's JSON report
    """
    found = []
    for file, measured in report["files"].items():
        functions = sorted(
            (-len(function["missing_lines"]), function.get("start_line", function["missing_lines"][0]), name)
            for name, function in measured["functions"].items()
            # Lines outside of functions have no name.
            if name and function["missing_lines"] and not function["executed_lines"]
        )
        if functions:
            found.append((sum(lines for lines, _, _ in functions), file, functions))
    text = ["", "Functions never run, worst first:"]
    for total, file, functions in sorted(found):
        text.append(f"{file}: {counted(len(functions), 'function')}, {counted(-total, 'line')}")
        text += [f"  {name} ({file}:{start}), {counted(-lines, 'line')}" for lines, start, name in functions]
    return "\n".join(text) if found else ""
