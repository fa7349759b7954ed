"""Remembers which tests have passed; with ``--changed``, only tests run that a change can have reached."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from ..compat.unrepeatable import real_time_libraries
from ..passes.memory import Passes, loaded_from_elsewhere
from ..passes.written import written_files
from ..project import Project
from ..wording import counted
from .options import TestOptions

#: The name under which pytest registers the plugin.
PASSES = "pyfrc.passes"

#: Arguments of pytest that change neither which tests run nor how they end.
_HARMLESS = ("-v", "-q", "-s", "-x", "-r", "--tb", "--color", "--durations", "--junit")


class RememberedPasses:
    """Remembers the passes of one run.

    :param args: the arguments that the user has given to pytest
    :param builtin: whether the ready-made tests run in any case
    """

    __name__ = PASSES

    def __init__(self, project: Project, options: TestOptions, args: Sequence[str], builtin: bool = False) -> None:
        self._project = project
        self._only_changed = options.only_changed
        self._passes = Passes(project, options.seed, builtin)
        #: What the tests' processes have imported from outside the project, and what pyfrc has written there.
        self._elsewhere: set[str] = set()
        self._written: set[str] = set()
        self._runs_all = all(argument.startswith(_HARMLESS) for argument in args)
        self._valid = 0
        #: The file of each test.
        self._files: dict[str, Path] = {}
        self._ran: set[str] = set()
        self._not_passed: set[str] = set()
        #: Why nothing of this run is remembered.
        self._why_not = ""

    def record_real_time(self, libraries: Sequence[str]) -> None:
        """Note that a test's process has libraries that simulate devices in real time: its pass may be chance."""
        self._why_not = f"{libraries[0]} simulates devices in real time, so this robot does not repeat exactly"

    def record_files(self, elsewhere: set[str], written: set[str]) -> None:
        """Note what a test's process has imported from outside the project, and what pyfrc has written in it."""
        self._elsewhere |= elsewhere
        self._written |= written

    def record_left_over(self, reason: str) -> None:
        """Note what a test has left, for which the next one needed a new interpreter."""
        self._passes.set_left_over(reason)

    def pytest_configure(self, config: pytest.Config) -> None:
        if self._only_changed and getattr(config.option, "dist", "no") != "no":
            raise pytest.UsageError("--changed and pytest-xdist's -n are mutually exclusive: pyfrc has -j of its own.")

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        self._files = {item.nodeid: item.path for item in items}
        if self._only_changed:
            left = [item for item in items if not self._passes.is_valid(item.nodeid, item.path)]
            self._valid = len(items) - len(left)
            items[:] = left

    def pytest_deselected(self, items: Sequence[pytest.Item]) -> None:
        self._runs_all = False

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self._ran.add(report.nodeid)
        if report.outcome != "passed":
            self._not_passed.add(report.nodeid)

    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        if self._valid and exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED:
            session.exitstatus = exitstatus = pytest.ExitCode.OK
        if libraries := real_time_libraries():
            self.record_real_time(libraries)
        for test in self._not_passed:
            self._passes.forget(test)
        for test in self._ran - self._not_passed:
            if test in self._files and not self._why_not:
                self._passes.record(test, self._files[test])
        if exitstatus != pytest.ExitCode.OK or self._why_not:
            self._passes.set_green(False)
        elif self._runs_all and not self._valid:  # else some passed before a change that they do not depend on
            self._passes.set_green(True)
        self.record_files(loaded_from_elsewhere(self._project), written_files)
        if (report := getattr(session.config.option, "xmlpath", None)) is not None:  # pytest has written it now
            self._written.add(str(Path(report).absolute()))
        self._why_not = self._passes.save(self._elsewhere, self._written) or self._why_not

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        if self._valid:
            passed = f"{counted(self._valid, 'test')} passed before; the project's files that they depend on"
            terminalreporter.write_line(f"{passed}, Python and packages have not changed since")
        if self._only_changed and self._why_not:
            terminalreporter.write_line(f"pyfrc: the passes are not remembered, because {self._why_not}", yellow=True)
