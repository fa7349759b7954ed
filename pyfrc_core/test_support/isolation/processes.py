"""The processes that tests run in: forked from this one, or new interpreters."""

from __future__ import annotations

import signal
import tempfile
from functools import partial
from typing import IO

import pytest

from ...compat.pytest_private import capture_into
from ...processes.crash_report import CrashLog
from ...processes.standstill import StandstillNotice
from ...processes.worker import ForkedWorker, Send, SpawnedWorker, Worker
from ...runtime.turns import take
from ..pytest_plugin import PyFrcPlugin
from .messages import ReportSender
from .uncaptured import UncapturedOutput


class Captured:
    """What a process prints, to stdout and stderr, and pytest has not yet collected when the process ends."""

    def __init__(self) -> None:
        self.stdout: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed by `close`
        self.stderr: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 - closed likewise

    def text(self) -> str:
        text = ""
        for file in (self.stdout, self.stderr):
            file.seek(0)
            text += file.read().decode(errors="replace")
        return text.strip()

    def close(self) -> None:
        self.stdout.close()
        self.stderr.close()


class TestProcess:
    """One test in its own process."""

    __test__ = False  # pytest: not a test class, for all its name

    def __init__(self, worker: Worker, captured: Captured, nodeid: str) -> None:
        self.worker = worker
        self.notice = StandstillNotice(nodeid)
        self._captured = captured

    def captured(self) -> str:
        """Return what the process printed since its last report."""
        return self._captured.text()

    def close(self) -> None:
        """Remove what the process has left, once it is reported."""
        self.worker.close()
        self._captured.close()


def forked_test(item: pytest.Item, plugin: PyFrcPlugin, output: UncapturedOutput | None) -> TestProcess:
    """Begin a test in a fork of this process: everything imported is there already.

    :param output: where it prints to, if pytest captures nothing
    """
    captured = Captured()
    files = captured.stdout.fileno(), captured.stderr.fileno()
    return TestProcess(ForkedWorker(partial(_run_in_fork, item, plugin, files, output)), captured, item.nodeid)


def spawned_test(item: pytest.Item, plugin: PyFrcPlugin) -> TestProcess:
    """Begin a test in a new interpreter, which collects the tests again and runs one of them."""
    from .spawned import TestJob, run_in_interpreter

    captured = Captured()
    job = TestJob(
        [str(argument) for argument in item.config.invocation_params.args],
        str(item.config.invocation_params.dir),
        item.nodeid,
        plugin.project.main_file,
        plugin.project.class_name,
        plugin.options,
    )
    return TestProcess(
        SpawnedWorker(partial(run_in_interpreter, job), captured.stdout, captured.stderr), captured, item.nodeid
    )


# -- on the other side -----------------------------------------------------------------------------------------------


def _run_in_fork(
    item: pytest.Item,
    plugin: PyFrcPlugin,
    files: tuple[int, int],
    output: UncapturedOutput | None,
    send: Send,
    log: CrashLog,
) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    take()
    capture_into(item.config, files)
    if output is not None:
        output.connect_this_process()
    plugin.crash_log = log
    log.enable_fault_handler()  # pytest has one of its own
    ReportSender(send).run(item)
