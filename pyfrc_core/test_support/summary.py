"""What `pyfrc test` changes in pytest's output.

Each bug is explained once. Methods that WPILib never calls are listed. What libraries print about themselves is removed
from the captured output.

Reports are shortened on the terminal only: JUnit files and other reports contain each failure in full.
"""

from __future__ import annotations

import copy
import sys
from collections.abc import Generator
from typing import Any, TextIO

import pytest

from ..compat.library_output import LibraryOutput
from ..compat.real_time_devices import explain_real_time
from ..project import Project
from ..runtime.misspelled_methods import find_misspelled_methods
from .reporting import BUG, REAL_TIME, put_first


class SummaryPlugin:
    """The plugin that shortens and extends pytest's summary.

    :param project: the robot project under test
    """

    def __init__(self, project: Project) -> None:
        self._project = project
        self._output = LibraryOutput()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Remove libraries' lines from what a test has printed."""
        # What is said once is said where it is seen: a test that passed shows nothing.
        output = self._output if report.failed else LibraryOutput()
        sections = (
            (name, output.of_whole(text) if name.startswith("Captured ") else text) for name, text in report.sections
        )
        report.sections = [(name, text) for name, text in sections if text]

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_terminal_summary(self, terminalreporter: Any, config: pytest.Config) -> Generator[None, object, object]:
        if not config.option.fulltrace:
            _explain_each_bug_once(terminalreporter.stats)
        _explain_real_time_devices(terminalreporter)
        result = yield
        misspelled = find_misspelled_methods(self._project)
        if misspelled:  # last, since failures may fill the screen
            terminalreporter.section("misspelled methods", yellow=True, bold=True)
            for method in misspelled:
                terminalreporter.write_line(str(method), yellow=True)
        return result


def warn_of_misspelled_methods(project: Project, stream: TextIO = sys.stderr) -> None:
    """Print the misspelled methods of the modules that this process has imported."""
    for method in find_misspelled_methods(project):
        print(f"warning: {method}", file=stream)


def _explain_real_time_devices(terminalreporter: Any) -> None:
    """Explain, once, why recordings of this robot do not repeat."""
    reports = [report for group in terminalreporter.stats.values() for report in group]
    devices = sorted({device for report in reports for device in getattr(report, REAL_TIME, ())})
    if devices:
        terminalreporter.write_line(explain_real_time(devices))


def _explain_each_bug_once(stats: dict[str, list[object]]) -> None:
    """Replace the failures by a bug that was explained before by a reference to the explanation."""
    explained: dict[str, str] = {}
    for outcome in ("error", "failed"):  # in the order in which they are shown
        reports = stats.get(outcome, [])
        for index, report in enumerate(reports):
            bug = getattr(report, BUG, None)
            if not isinstance(report, pytest.TestReport) or bug is None:
                continue
            if bug not in explained:
                explained[bug] = _name(report)
            elif explained[bug] != _name(report):
                reports[index] = _pointing_to(report, bug, explained[bug])


def _pointing_to(report: pytest.TestReport, bug: str, explained: str) -> pytest.TestReport:
    short = copy.copy(report)
    short.longrepr = copy.deepcopy(report.longrepr)
    place = bug.partition(": ")[0]
    text = f"{place}: the same as in {explained}, which is explained above"
    put_first(short, text, only=True)
    if isinstance(short.longrepr, str):
        short.longrepr = text
    short.sections = []
    return short


def _name(report: pytest.TestReport) -> str:
    return report.nodeid.partition("::")[2].replace("::", ".") or report.nodeid
