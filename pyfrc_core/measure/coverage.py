"""Which of the project's own lines run, also in the processes that tests are isolated in."""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import UsageError
from ..project import Project

if TYPE_CHECKING:
    from coverage import Coverage


@dataclass(frozen=True)
class CoverageOptions:
    """Which reports are wanted.

    :param fail_under: the least percentage that counts as success
    """

    enabled: bool
    html: Path | None = None
    xml: Path | None = None
    fail_under: float | None = None


@dataclass
class Measured:
    """What came of it: `status` is 1 when too little was covered."""

    status: int = 0


#: How processes that are started anew hear of it: an environment variable with the settings, as JSON.
_SETTINGS = "PYFRC_COVERAGE"


def measure_here() -> None:
    """Measure in this process, if it is part of a run that is measured. A fork goes on measuring by itself."""
    if _SETTINGS in os.environ:
        from coverage import Coverage

        measurement = Coverage(data_suffix=True, **json.loads(os.environ[_SETTINGS]))
        # A process that waits for others runs no line of the project, and need not complain of it.
        measurement.set_option("run:disable_warnings", ["no-data-collected"])
        measurement.start()


def save_here() -> None:
    """Keep what was measured in this process, if anything was."""
    coverage = sys.modules.get("coverage")
    current = coverage.Coverage.current() if coverage is not None else None
    if current is not None:
        current.stop()
        current.save()


@contextmanager
def measuring(project: Project, options: CoverageOptions) -> Iterator[Measured]:
    """Measure while this lasts, then report.

    Lines count wherever they run: here, in forked and spawned processes, in threads. Only the project's own robot
    code is measured: neither its tests nor anything installed.
    """
    result = Measured()
    if not options.enabled:
        yield result
        return
    from coverage import Coverage
    from coverage.exceptions import CoverageException

    for file, is_taken in ((options.html, Path.is_file), (options.xml, Path.is_dir)):
        if file is not None and is_taken(file):
            raise UsageError(f"the report cannot be written to {file}: something else is there already")
    # What each process measured lies here until it is combined; nothing of it is left in the project.
    with tempfile.TemporaryDirectory(prefix="pyfrc-coverage-") as directory:
        settings: dict[str, Any] = {
            "data_file": str(Path(directory) / "data"),
            "source": [str(project.root)],
            "omit": [*(f"{tests}/*" for tests in project.test_directories), "*/site-packages/*"],
            "config_file": str(project.pyproject) if project.pyproject.is_file() else False,
        }
        os.environ[_SETTINGS] = json.dumps(settings)
        try:
            measure_here()
            try:
                yield result
            finally:
                save_here()
                del os.environ[_SETTINGS]
            combined = Coverage(**settings)
            combined.combine([directory])
            result.status = _report(combined, options)
        except (CoverageException, ValueError) as error:
            where = project.pyproject.name if "config" in str(error).lower() else None
            raise UsageError(f"coverage: {error}", where=where) from error


def _report(combined: Coverage, options: CoverageOptions) -> int:
    from coverage.exceptions import NoDataError

    print()
    try:
        # A file that cannot be parsed is told and left out: it need not be one that the robot uses.
        total = combined.report(show_missing=True, ignore_errors=True, file=sys.stdout)
        if options.html is not None:
            combined.html_report(directory=str(options.html), ignore_errors=True)
            print(f"coverage as web pages: {options.html / 'index.html'}")
        if options.xml is not None:
            combined.xml_report(outfile=str(options.xml), ignore_errors=True)
            print(f"coverage as XML: {options.xml}")
    except NoDataError:
        print("coverage: no line of the project was run", file=sys.stderr)
        return 1
    if options.fail_under is not None and total < options.fail_under:
        print(f"coverage: {total:.1f} % is less than the {options.fail_under:g} % asked for", file=sys.stderr)
        return 1
    return 0
