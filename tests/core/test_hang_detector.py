"""Code that hangs: when it counts as that, how it is interrupted, and what is said; with given times."""

from __future__ import annotations

import atexit
import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.processes.standstill import Standstill
from pyfrc_core.runtime.checks import hang_detector
from pyfrc_core.runtime.checks.hang_detector import HangDetector, not_watched

DRIVER = 11


_CODE = SimpleNamespace(co_filename="", co_name="teleopPeriodic")


class World:
    """What a detector sees, look by look: the times of the thread that has the turn, wall time, and the robot's."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **options: Any) -> None:
        self.used = self.wall = 0.0
        #: For how long the thread has waited for a processor; None where the system does not say.
        self.starved: float | None = 0.0
        self.log: list[str] = []
        self.told: list[object] = []
        times = SimpleNamespace(cpu=lambda: self.used, starved=lambda: self.starved)
        self.turn = DRIVER
        self.run = SimpleNamespace(
            clock=SimpleNamespace(now_us=0, now=1.5),
            in_motion=True,
            threads=SimpleNamespace(
                driver=DRIVER, whose_turn=lambda: (self.turn, times), fail=lambda error: self.log.append("failed")
            ),
        )
        files = SimpleNamespace(
            root="",
            line_of_frame=lambda frame: f"robot.py:{frame.f_lineno}",
            is_robot_code=lambda name: name == "robot.py",
        )
        self.steps: Iterator[object] = iter(())
        self.frame = SimpleNamespace(f_lineno=7, f_back=None, f_code=_CODE)
        watchers = SimpleNamespace(starved=lambda: 0.0)
        monkeypatch.setattr(hang_detector, "ThreadTimes", lambda: watchers)
        monkeypatch.setattr(hang_detector, "_wall", lambda: self.wall)
        monkeypatch.setattr(hang_detector, "_wait", self._wait)
        monkeypatch.setattr(hang_detector, "exit_now", lambda code: self.log.append(f"exit {code}"))
        monkeypatch.setattr(hang_detector, "current_frames", lambda: {DRIVER: self.frame, 22: self.frame})
        monkeypatch.setattr(
            hang_detector, "faulthandler", SimpleNamespace(dump_traceback_later=lambda *args, **more: None)
        )
        monkeypatch.setattr(hang_detector.active_run, "run", self.run)
        self.detector = HangDetector(files, 10.0, **options)  # type: ignore[arg-type]
        self.detector._watched = 33, times  # type: ignore[assignment]
        self.interruption = self.detector._interruption
        monkeypatch.setattr(self.interruption, "interrupt", self._interrupt)
        monkeypatch.setattr(self.detector, "_report", self.told.append)

    def _wait(self, seconds: float) -> None:
        assert seconds == 0.25
        if next(self.steps, "end") == "end":
            self.interruption.over = True

    def _interrupt(self, ident: int, message: str) -> None:
        self.log.append(f"wall {self.wall:g}: {ident} {message.splitlines()[0]}")

    def watch(self, steps: Iterator[object]) -> list[str]:
        """Let the detector look once for each step."""
        self.steps = steps
        self.detector._watch()
        return self.log

    def passes(self, seconds: float, used: float = 0.0, starved: float = 0.0) -> Iterator[object]:
        """Let wall time pass, look by look.

        :param used: in which part of it the thread computes
        :param starved: in which part of it the thread waits for a processor
        """
        for _ in range(round(seconds / 0.25)):
            self.wall += 0.25
            self.used += 0.25 * used
            if self.starved is not None:
                self.starved += 0.25 * starved
            yield 1


def test_code_that_computes_while_robot_time_stands_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)

    def steps() -> Iterator[object]:
        yield from world.passes(9, used=1)
        world.run.clock.now_us = 20_000  # it moves: the count restarts
        yield 1
        yield from world.passes(10, used=1)

    assert world.watch(steps()) == [
        "failed",  # remembered, whatever the code catches
        "wall 19: 11 robot.py:7: the robot code hangs here: robot time has stood at 1.50 s through 10 s of computing.",
    ]
    assert str(world.detector.raised).startswith("robot.py:7: the robot code hangs here")


def test_the_loop_that_does_not_end_is_the_place_and_not_what_it_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    loop = world.frame

    def looks() -> Iterator[object]:
        for count, step in enumerate(world.passes(10, used=1)):  # a new call, each time
            world.frame = SimpleNamespace(f_lineno=100 + count, f_back=loop, f_code=_CODE)
            yield step

    assert world.watch(looks())[-1].startswith("wall 10: 11 robot.py:7: the robot code hangs here")


def test_code_that_waits_for_something_outside_hangs_as_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    assert world.watch(world.passes(10))[1] == (
        "wall 10: 11 robot.py:7: the robot code is blocked here: robot time has stood at 1.50 s for 10 s, "
        "waiting for the world outside."
    )


def test_the_time_in_which_a_busy_machine_does_not_let_it_run_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    assert world.watch(world.passes(39, used=0.25, starved=0.75)) == []
    world = World(monkeypatch)
    assert world.watch(world.passes(40, used=0.25, starved=0.75))[1].startswith("wall 40")


def test_a_process_that_was_stopped_does_not_hang(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)

    def steps() -> Iterator[object]:
        for _ in range(10):
            world.wall += 3600  # the machine was suspended
            yield 1

    assert world.watch(steps()) == []


def test_while_the_robots_code_does_not_run_nothing_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)

    def steps() -> Iterator[object]:
        world.run.in_motion = False
        yield from world.passes(50)
        world.run.in_motion = True
        yield from world.passes(9)

    assert world.watch(steps()) == []


def test_tests_may_compute_for_longer_than_robots_but_not_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    for used, seconds, what in ((1.0, 60, "hangs"), (0.0, 10, "is blocked")):
        world = World(monkeypatch, everything=True)
        world.run.in_motion = False
        world.frame = SimpleNamespace(f_lineno=7, f_back=None, f_code=_CODE)
        monkeypatch.setattr(hang_detector, "current_frames", lambda world=world: {33: world.frame})
        world.detector._files.is_robot_code = lambda name: False  # type: ignore[union-attr, method-assign]
        (entry,) = world.watch(world.passes(seconds, used=used))
        assert entry.startswith(f"wall {seconds}: 33 robot.py:7: the test {what} here")


def test_a_thread_that_outlives_its_test_is_the_one_that_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch, everything=True)
    world.run.in_motion = False
    world.detector.outside = 22
    ended: list[object] = []
    monkeypatch.setattr(hang_detector, "raise_in_thread", lambda *what: ended.append(what))
    assert world.watch(world.passes(10)) == []
    assert ended == [(22, SystemExit)]
    assert str(world.detector.raised).startswith(
        "robot.py:7: a thread that the test has started is still running, 10 s after the test."
    )


def test_the_import_of_a_library_may_take_long(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    users = world.frame
    world.frame = SimpleNamespace(
        f_lineno=1, f_back=users, f_code=SimpleNamespace(co_filename="<frozen importlib._bootstrap>")
    )
    world.detector._files.line_of_frame = lambda frame: "robot.py:7" if frame is users else None  # type: ignore
    assert world.watch(world.passes(60, used=1)) == []
    assert world.told[-1] == Standstill(60.0, "robot.py:7", 1.5)


def test_in_a_debugger_nothing_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    world.detector.paused = True
    assert world.watch(world.passes(60)) == []


def test_an_interruption_that_comes_too_late_does_nothing() -> None:
    interruption = hang_detector._Interruption()
    with interruption.possible():
        interruption.end()
    interruption.interrupt(
        threading.main_thread().ident or 0, "it would end this process by a signal without a handler"
    )


def test_what_pyfrc_itself_waits_for_does_not_hang(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch, everything=True)
    monkeypatch.setattr(hang_detector, "_active", world.detector)
    with not_watched():
        assert world.watch(world.passes(60)) == []
    assert not world.detector.paused


def test_at_the_end_of_a_python_that_starts_no_thread_then_nothing_is_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    registered: list[Any] = []

    def no_thread(run: object) -> None:
        raise RuntimeError("can't create new thread at interpreter shutdown")

    monkeypatch.setattr(hang_detector, "start_bare_thread", no_thread)
    monkeypatch.setattr(atexit, "register", lambda *call: registered.append(call))
    with hang_detector.watching_exit(SimpleNamespace(), 10.0):
        pass
    before = hang_detector._active
    for function, *arguments in reversed(registered):
        function(*arguments)
    assert hang_detector._active is before
