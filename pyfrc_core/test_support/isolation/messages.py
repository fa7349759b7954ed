"""What a test's own process sends to the one that reports: pytest's reports and warnings, as pairs.

Each is sent as soon as it is made, so that what came before a crash can be reported.
"""

from __future__ import annotations

import warnings
from collections.abc import Generator
from typing import Any

import pytest

from ...compat.pytest_private import run_test_protocol
from ...compat.unrepeatable import real_time_libraries
from ...passes.memory import loaded_from_elsewhere
from ...passes.written import written_files
from ...processes.worker import Send
from ...project import Project
from ..remembered_passes import PASSES

Message = tuple[str, Any]


class ReportSender:
    """Runs one test in its own process and sends everything that a report needs."""

    def __init__(self, send: Send, project: Project) -> None:
        self._send = send
        self._project = project
        self._listening = False

    def run(self, item: pytest.Item, shares: bool = True) -> None:
        """The whole of pytest's protocol for `item`, without a report on this side.

        :param shares: whether what the test shares with others is torn down by the other side
        """
        # On registering, pytest calls the hook again for each warning so far: those the other side knows.
        item.config.pluginmanager.register(self, "pyfrc.report_sender")
        self._listening = True
        try:
            # With the item's parent for the next item, what the test shares with others is not torn down here.
            item.ihook.pytest_runtest_protocol(item=item, nextitem=item.parent if shares else None)
        except pytest.exit.Exception as leaving:
            self.send("exit", (leaving.msg, leaving.returncode))
        except KeyboardInterrupt:
            self.send("interrupted", None)
        if item.session.shouldstop:
            self.send("stop", item.session.shouldstop)
        if libraries := real_time_libraries():
            self.send("real time", libraries)
        elsewhere = loaded_from_elsewhere(self._project, with_pyfrc=False)
        if elsewhere or written_files:
            self.send("files", (elsewhere, written_files))
        self.send("done", None)

    def send(self, kind: str, content: object) -> None:
        self._send((kind, content))

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: Any) -> bool:
        run_test_protocol(item, nextitem)
        return True

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_makereport(self, item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Send each report as soon as it is made: the next phase may end the process."""
        report = yield
        self.send("report", item.config.hook.pytest_report_to_serializable(config=item.config, report=report))
        return report

    def pytest_warning_recorded(
        self, warning_message: warnings.WarningMessage, when: str, nodeid: str, location: object
    ) -> None:
        if not self._listening:
            return
        plain = {
            "message": str(warning_message.message),
            "category": warning_message.category,
            "filename": warning_message.filename,
            "lineno": warning_message.lineno,
        }
        try:
            self.send("warning", (plain, when, nodeid, location))
        except Exception:  # a category that cannot be pickled, being local to a function
            self.send("warning", (plain | {"category": UserWarning}, when, nodeid, location))


def replay(item: pytest.Item, message: Message) -> pytest.TestReport | None:
    """Report here what the test's process has sent; return the report, if it is one."""
    kind, content = message
    hook: Any = item.ihook
    if kind == "report":
        report = item.config.hook.pytest_report_from_serializable(config=item.config, data=content)
        hook.pytest_runtest_logreport(report=report)
        return report  # type: ignore[no-any-return]
    if kind == "warning":
        plain, when, nodeid, location = content
        hook.pytest_warning_recorded.call_historic(
            kwargs={
                "warning_message": warnings.WarningMessage(**plain),
                "when": when,
                "nodeid": nodeid,
                "location": location,
            }
        )
    elif kind in ("real time", "files"):
        passes: Any = item.config.pluginmanager.getplugin(PASSES)
        if passes is not None and kind == "real time":  # a plain `pytest` has none
            passes.record_real_time(content)
        elif passes is not None:
            passes.record_files(*content)
    elif kind == "exit":
        raise pytest.exit.Exception(content[0], content[1])
    elif kind == "interrupted":
        raise KeyboardInterrupt
    elif kind == "stop":
        item.session.shouldstop = content
    return None
