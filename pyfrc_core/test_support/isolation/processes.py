"""The processes that tests run in: forked from this one, or new interpreters."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import IO

import pytest

from ...compat.pytest_private import capture_into
from ...processes.crash_report import CrashLog
from ...processes.interpreter import SpawnedWorker
from ...processes.reuse import Interpreters
from ...processes.standstill import StandstillNotice
from ...processes.worker import ForkedWorker, Send, Worker
from ...runtime.turns import acquire, lock_directory
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

    def __init__(self, worker: Worker, captured: Callable[[], str], close: Callable[[], object], nodeid: str) -> None:
        self.worker = worker
        self.notice = StandstillNotice(nodeid)
        #: Return what the process printed since its last report.
        self.captured = captured
        #: Remove what the process has left, once it is reported.
        self.close = close

    def show(self) -> None:
        """Print what it has printed, where pytest captures nothing: a fork has printed that itself."""
        if isinstance(self.worker, SpawnedWorker):
            sys.stdout.write(self.captured())


def forked_test(item: pytest.Item, plugin: PyFrcPlugin, output: UncapturedOutput | None) -> TestProcess:
    """Begin a test in a fork of this process: everything imported is there already.

    :param output: where it prints to, if pytest captures nothing
    """
    captured = Captured()
    files = captured.stdout.fileno(), captured.stderr.fileno()
    worker = ForkedWorker(partial(_run_in_fork, item, plugin, files, output))

    def close() -> None:
        worker.close()
        captured.close()

    return TestProcess(worker, captured.text, close, item.nodeid)


def spawned_test(item: pytest.Item, plugin: PyFrcPlugin, interpreters: Interpreters, more: int) -> TestProcess:
    """Begin a test in another interpreter, which collects the tests again and runs one of them.

    :param more: how many tests are known to follow
    """
    from .spawned import AUTOLOADED, OUTPUT, TestJob, run_in_interpreter

    job = TestJob(
        [str(argument) for argument in item.config.invocation_params.args],
        str(item.config.invocation_params.dir),
        item.nodeid,
        replace(plugin.project),
        plugin.options,
        lock_directory(),
        plugin.published,
        all(
            getattr(each, "__name__", "") == AUTOLOADED for each, _ in item.config.pluginmanager.list_plugin_distinfo()
        ),
    )
    worker = interpreters.begin(partial(run_in_interpreter, job), more)

    def files() -> list[Path]:
        return [file for kind, content in worker.messages() if kind == OUTPUT for file in content]

    def captured() -> str:
        return worker.printed() + "".join(file.read_text("utf-8", "replace") for file in files())

    def close() -> None:
        left = files()
        interpreters.end(worker)
        for file in left:
            try:
                file.unlink()
            except OSError:  # on Windows: the interpreter still has it open
                interpreters.left.append(file)

    return TestProcess(worker, captured, close, item.nodeid)


# -- on the other side -----------------------------------------------------------------------------------------------


def _run_in_fork(
    item: pytest.Item,
    plugin: PyFrcPlugin,
    files: tuple[int, int],
    output: UncapturedOutput | None,
    send: Send,
    log: CrashLog,
) -> None:
    acquire()
    capture_into(item.config, files)
    if output is not None:
        output.connect_this_process()
    plugin.crash_log = log
    log.enable_fault_handler()  # pytest has one of its own
    ReportSender(send, plugin.project).run(item)
