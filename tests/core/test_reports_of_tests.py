"""What a run of tests says of its failures: one bug once, mistakes beside the failures, threads that do not end."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from loops import for_each

from pyfrc_core.test_support import hangs
from pyfrc_core.test_support.hangs import WatchedTests
from pyfrc_core.test_support.reporting import bug_of
from pyfrc_core.test_support.run_tests import _start_directory


@for_each(
    "headline, bug",
    [
        ("robot.py:12: ZeroDivisionError: division by zero", "robot.py:12: ZeroDivisionError: division by zero"),
        ("src/arm.py:7: ValueError: at 12.34 s: 0x7f00ab is 1e-05", "src/arm.py:7: ValueError: at # s: # is #"),
        ("robot.py:3: Odd: one\ntwo", "robot.py:3: Odd: one"),
        ("robot.py:3: a.py:4: b", "robot.py:3: a.py:#: b"),
        ("the robot program ended", None),
        ("line\nrobot.py:12: Odd: late", None),
        ("robot.txt:12: Odd: no module", None),
        ("", None),
        (None, None),
    ],
)
def test_what_failures_by_one_bug_have_in_common(headline: str | None, bug: str | None) -> None:
    assert bug_of(headline) == bug


class Hangs:
    """A detector: it counts the progress that it is shown."""

    def __init__(self, raised: Exception | None = None) -> None:
        self.outside: int | None = None
        self.judges = True
        self.outside_factor = 10.0
        self.raised = raised
        self.progress = 0

    def proceed(self) -> None:
        self.progress += 1


def test_a_thread_that_a_test_leaves_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    alive = [True, True, False]
    detector: Any = Hangs()
    seen: list[tuple[int | None, float]] = []
    thread: Any = SimpleNamespace(ident=7, is_alive=lambda: alive.pop(0))
    monkeypatch.setattr(
        hangs,
        "real_thread_join",
        lambda thread, seconds: seen.append((detector.outside, detector.outside_factor)),
    )
    hangs._await(thread, detector)
    # Meanwhile, it is the one that the detector watches, as strictly as the robot's code.
    assert seen == [(7, 1.0), (7, 1.0)]
    assert (detector.outside, detector.progress, alive) == (None, 1, [])


def test_a_thread_that_hangs_fails_the_test(monkeypatch: pytest.MonkeyPatch) -> None:
    detector: Any = Hangs(TimeoutError("thread 7 is blocked"))
    thread: Any = SimpleNamespace(ident=7, is_alive=lambda: False)
    with pytest.raises(TimeoutError, match="thread 7 is blocked"):
        hangs._await(thread, detector)
    assert detector.outside is None


def called(detector: Any, body: Callable[[], object]) -> None:
    """Call a test's function as the plugin does."""
    plugin = WatchedTests()
    plugin._hangs = detector
    call = plugin.pytest_runtest_call()
    next(call)
    body()
    with suppress(StopIteration):
        next(call)


def test_a_hang_whose_interruption_the_test_catches_is_a_failure() -> None:
    detector = Hangs()
    called(detector, lambda: None)

    def catch() -> None:
        detector.raised = TimeoutError("the test hangs here")

    with pytest.raises(TimeoutError, match="the test hangs here"):
        called(detector, catch)


def test_only_threads_that_a_robots_test_starts_are_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    detector, waited = Hangs(), list[str]()
    monkeypatch.setattr(hangs, "_await", lambda thread, detector: waited.append(thread.name))
    done = threading.Event()

    def start() -> None:
        for name, daemon in (("work", False), ("camera", True)):
            threading.Thread(target=done.wait, name=name, daemon=daemon).start()

    monkeypatch.setattr(hangs, "test_that_started", lambda thread: "the test")
    try:
        for detector.judges in (True, False):
            called(detector, start)
    finally:
        done.set()
    assert waited == ["work"]


@for_each("name, from_the_project", [("robot", False), ("our [robot]", True), ("at::home", True), ("50% $", True)])
def test_a_path_that_pytest_would_read_otherwise_is_not_used(
    name: str, from_the_project: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = tmp_path / name
    root.mkdir()
    monkeypatch.chdir(tmp_path)
    project: Any = SimpleNamespace(root=root, pyproject=root / "pyproject.toml")
    assert _start_directory(project) == (root if from_the_project else tmp_path)
