"""What `pyfrc test` changes in pytest's output.

Each bug is explained once. Methods that WPILib never calls are listed. What libraries print about themselves is removed
from the captured output.

Reports are shortened on the terminal only: JUnit files and other reports contain each failure in full.
"""

from __future__ import annotations

import copy
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest

from ..compat.library_output import LibraryOutput
from ..compat.unrepeatable import explain_unrepeatable
from ..project import Project
from ..repeated_lines import shortened
from ..runtime.checks.code_checks import find_code_warnings
from .device_misuse import DeviceWarning
from .reporting import BUG, UNREPEATABLE, put_first
from .uncollected import find_uncollected

#: How many lines a failure has, if that leaves the fewest for the test's output.
_LINES = 24
_FEWEST = 6


class SummaryPlugin:
    """The plugin that shortens and extends pytest's summary.

    :param project: the robot project under test
    :param whole: whether all of the project's tests are to run
    """

    def __init__(self, project: Project, whole: bool = False) -> None:
        self._project = project
        self._whole = whole
        self._collected: set[Path] = set()
        self._uncollected: list[str] = []
        self._unreadable: list[str] = []
        self._output = LibraryOutput()

    def pytest_configure(self, config: pytest.Config) -> None:
        """Show the failing lines only, and not the functions around them, unless the user wants more."""
        if config.option.tbstyle == "auto" and config.option.verbose <= 0:
            config.option.tbstyle = "short"

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
    def pytest_terminal_summary(
        self, terminalreporter: Any, exitstatus: int, config: pytest.Config
    ) -> Generator[None, object, object]:
        if not config.option.fulltrace:
            _explain_each_bug_once(terminalreporter.stats)
            if config.option.verbose <= 0:
                _shorten_output(terminalreporter.stats)
        _explain_unrepeatable_devices(terminalreporter)
        # Before the failures, of which they may be the reason.
        mistakes = [f"{mistake}\n  {mistake.remedy}" for mistake in find_code_warnings(self._project)]
        mistakes += _take_device_warnings(terminalreporter.stats)
        _print_section(terminalreporter, "mistakes without an error", mistakes)
        _print_section(terminalreporter, "files that cannot be read", self._unreadable)
        if exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED, pytest.ExitCode.NO_TESTS_COLLECTED):
            _print_section(terminalreporter, "files without tests", self._uncollected)
        return (yield)

    def pytest_itemcollected(self, item: pytest.Item) -> None:
        self._collected.add(item.path)

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self._unreadable = [str(each) for each in self._project.unreadable_sources()]
        directory = self._project.find_tests() if self._whole else None
        if directory is not None and not session.testsfailed:
            patterns = session.config.getini("python_files")
            self._uncollected = list(find_uncollected(directory, self._collected, patterns))


def _print_section(terminalreporter: Any, title: str, lines: list[str]) -> None:
    if lines:
        terminalreporter.write_sep("=", title, yellow=True, bold=True)
        for line in lines:
            terminalreporter.write_line(line, yellow=True)


def _take_device_warnings(stats: dict[str, list[Any]]) -> list[str]:
    """Remove the warnings about devices from pytest's, which has the tests before the line, and return each once."""
    mark = f"{DeviceWarning.__name__}: "
    taken = [each.message for each in stats.get("warnings", []) if mark in each.message]
    if taken:
        stats["warnings"] = [each for each in stats["warnings"] if mark not in each.message]
    return list(dict.fromkeys(message.partition(mark)[2].partition("\n")[0] for message in taken))


def _explain_unrepeatable_devices(terminalreporter: Any) -> None:
    """Explain, once, why recordings of this robot do not repeat."""
    reports = [report for group in terminalreporter.stats.values() for report in group]
    devices = sorted({device for report in reports for device in getattr(report, UNREPEATABLE, ())})
    if devices:
        terminalreporter.write_line(explain_unrepeatable(devices))


def _shorten_output(stats: dict[str, list[object]]) -> None:
    """Show only the end of what a failed test has printed, so that a failure fits on the screen."""
    for outcome in ("error", "failed"):
        reports = stats.get(outcome, [])
        for index, report in enumerate(reports):
            if isinstance(report, pytest.TestReport):
                room = max(_FEWEST, _LINES - str(report.longrepr).count("\n") - 2 * len(report.sections))
                reports[index] = short = copy.copy(report)
                short.sections = [(name, _end_of(text, room)) for name, text in report.sections]


def _end_of(text: str, room: int) -> str:
    lines = shortened(text).splitlines(keepends=True)
    left_out = len(lines) - room
    return (
        "".join(lines)
        if left_out <= 1
        else f"({left_out} lines before these: pyfrc test -v)\n" + "".join(lines[left_out:])
    )


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
