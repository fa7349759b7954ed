"""One test in a new interpreter: collects the tests again, runs one, and sends its reports."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from ...compat.pytest_private import capture_into
from ...processes.crash_report import CrashLog
from ...processes.worker import Send
from ..options import TestOptions

if TYPE_CHECKING:
    from ...errors import RobotCodeError
    from ...project import Project
    from ...wpi.opmodes import PublishedOpmode
    from ..pytest_plugin import PyFrcPlugin


#: The kind of the message with the files of standard output and standard error that pytest captures into.
OUTPUT = "output"

#: The plugin that pytest finds if pyfrc is installed. It does nothing where pyfrc runs the tests.
AUTOLOADED = "pyfrc_core.test_support.autoload"


@dataclass(frozen=True)
class TestJob:
    """Which test to run, and how pytest was called.

    :param args: pytest's arguments
    :param directory: where pytest was called
    :param turns: see `turns.lock_directory`
    :param project: without what the other process has read of it
    :param published: see `PyFrcPlugin`
    :param no_plugins: whether no plugin is installed but pyfrc's own
    """

    __test__ = False  # pytest: not a test class, for all its name

    args: list[str]
    directory: str
    nodeid: str
    project: Project
    options: TestOptions
    turns: str | None
    published: tuple[PublishedOpmode, ...] | RobotCodeError | None
    no_plugins: bool = False


class OnlyOneTest:
    """Runs the one test of the job, silently, through the same protocol as a forked test."""

    def __init__(self, job: TestJob, plugin: PyFrcPlugin, send: Send, log: CrashLog) -> None:
        self._job, self._plugin, self._send, self._log = job, plugin, send, log

    @pytest.hookimpl(trylast=True)
    def pytest_configure(self, config: pytest.Config) -> None:
        # What is reported, the other end reports.
        for name in ("terminalreporter", "junitxml"):
            reporter = config.pluginmanager.getplugin(name)
            if reporter is not None:
                config.pluginmanager.unregister(reporter)

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        from ...runtime.turns import acquire
        from .messages import ReportSender

        self._send((OUTPUT, _capture_into_files(session.config, self._job.turns)))
        acquire(self._job.turns)
        self._plugin.crash_log = self._log
        self._log.enable_fault_handler()  # pytest has one of its own
        for item in session.items:
            if item.nodeid == self._job.nodeid:
                ReportSender(self._send, self._job.project).run(item, shares=False)
        return True


def _capture_into_files(config: pytest.Config, directory: str | None) -> list[Path]:
    """Have pytest capture into files that outlive this process; the other one removes them."""
    files = [tempfile.mkstemp(dir=directory) for _ in range(2)]
    (stdout, _), (stderr, _) = files
    capture_into(config, (stdout, stderr))
    for descriptor, _ in files:
        os.close(descriptor)
    return [Path(name) for _, name in files]


def run_in_interpreter(job: TestJob, send: Send, log: CrashLog) -> int:
    """Run the test, and return pytest's exit code."""
    os.chdir(job.directory)
    if job.no_plugins:  # to look for some takes as long as many tests
        os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    from ..pytest_plugin import PyFrcPlugin

    project = job.project
    _ = project.settings  # before pytest reads the same pyproject.toml, which may begin with a byte-order mark
    plugin = PyFrcPlugin(
        None, project.main_file, project.root, project=project, options=job.options, published=job.published
    )
    status = pytest.main(job.args, plugins=[plugin, OnlyOneTest(job, plugin, send, log)])
    plugin.forget_robot()  # pytest's import hook, which has the plugins, stays with each module that it has imported
    return int(status)
