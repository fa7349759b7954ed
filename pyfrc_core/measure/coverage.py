"""Measure which of the project's own lines run, also in the processes of isolated tests."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import UsageError
from ..project import Project
from ..text_files import check_writable, write_whole
from .never_run import never_run
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

    if options.html is not None:
        check_writable("--html", options.html / "index.html")
    for option, file in (("--xml", options.xml), ("--json", options.json)):
        check_writable(option, file)
    # The directory for the data of each process, until it is combined; nothing stays in the project.
    with tempfile.TemporaryDirectory(prefix="pyfrc-coverage-") as directory:
        settings: dict[str, Any] = {
            "data_file": str(Path(directory) / "data"),
            "source": [str(project.root)],
            "omit": [*(f"{tests}/*" for tests in project.test_directories), "*/site-packages/*"],
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
    except NoDataError:
        print("coverage: no line of the project was run", file=sys.stderr)
        return 1
    if options.fail_under is not None and total < options.fail_under:
        print(f"coverage: {total:.1f} % is less than the required {options.fail_under:g} %", file=sys.stderr)
        return 1
    return 0
