"""Tests whose code hangs: each is watched from its first fixture to its last, wherever its process is."""

from __future__ import annotations

import os
import threading
from collections.abc import Generator
from contextlib import suppress
from typing import TYPE_CHECKING

import pytest

from ..runtime.checks.hang_detector import HangDetector
from ..runtime.threads.cooperative import test_that_started
from ..runtime.threads.robot_threads import real_thread_join

if TYPE_CHECKING:
    from ..processes.crash_report import CrashLog
    from ..project import Project
    from .options import TestOptions

#: The fixtures that use the robot: a test with one of them runs in a separate process.
ROBOT_FIXTURES = frozenset({"control", "fake_time", "hal_data", "physics_controller", "robot", "wpilib"})

#: Wall seconds between two looks at a thread that the test has left running: an interruption comes between them.
_JOIN_SECONDS = 0.05


class WatchedTests:
    """The part of the plugin that watches tests for code that hangs."""

    project: Project
    options: TestOptions
    crash_log: CrashLog | None

    _terminal = 2
    _hangs: HangDetector | None = None

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionstart(self) -> None:
        with suppress(OSError):
            self._terminal = os.dup(2)  # which pytest redirects while a test runs

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        self._hangs = HangDetector(
            self.project.files,
            self.options.hang_seconds,
            self.crash_log,
            everything=True,
            terminal=self._terminal,
            meanwhile=item.nodeid,
        )
        # Other tests of the project may take as long as they like; what they wait for is said.
        uses_robot = ROBOT_FIXTURES.intersection(getattr(item, "fixturenames", ()))
        self._hangs.judges = self.crash_log is not None or bool(uses_robot)
        with self._hangs.watching():
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self) -> Generator[None, None, None]:
        hangs, before = self._hangs, threading.enumerate()
        assert hangs is not None
        hangs.proceed()
        yield
        if hangs.raised is not None:  # and the code has caught it
            raise hangs.raised
        for thread in threading.enumerate():
            if thread not in before and not thread.daemon and test_that_started(thread) and hangs.judges:
                _await(thread, hangs)

    @pytest.hookimpl(tryfirst=True)
    def pytest_fixture_setup(self) -> None:
        if self._hangs is not None:
            self._hangs.proceed()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_teardown(self) -> None:
        if self._hangs is not None:
            self._hangs.proceed()

    def pytest_enter_pdb(self) -> None:
        if self._hangs is not None:
            self._hangs.paused = True

    def pytest_leave_pdb(self) -> None:
        if self._hangs is not None:
            self._hangs.paused = False

    def pytest_keyboard_interrupt(self, excinfo: pytest.ExceptionInfo[BaseException]) -> None:
        line = self.project.files.innermost_line(excinfo.tb)
        if line is not None:
            with suppress(OSError):
                os.write(self._terminal, f"\ninterrupted at {line}\n".encode(errors="replace"))


def _await(thread: threading.Thread, hangs: HangDetector) -> None:
    """Wait for a thread that the test has started, as Python would at its end: it must end, too."""
    hangs.outside, hangs.outside_factor = thread.ident, 1.0
    hangs.proceed()
    while thread.is_alive():
        real_thread_join(thread, _JOIN_SECONDS)
    hangs.outside = None
    if hangs.raised is not None:
        raise hangs.raised
