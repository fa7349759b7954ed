"""Code that hangs: when it counts as that, how it is interrupted, and what is said; with given times."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.runtime import hang_detector
from pyfrc_core.runtime.exceptions import TestFroze
from pyfrc_core.runtime.hang_detector import EXIT_HANGS, HangDetector, importing

DRIVER = 11


class World:
    """What a detector sees, look by look: processor and wall time, and the robot's. One look, one `step`."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **options: Any) -> None:
        #: Processor time of all threads, and of those that do not have the turn.
        self.cpu = self.others = 0.0
        self.wall = 0.0
        self.log: list[str] = []
        self.run = SimpleNamespace(
            clock=SimpleNamespace(now_us=0, now=1.5),
            in_motion=True,
            threads=SimpleNamespace(running=None, driver=DRIVER, cpu_of_running=lambda: self.cpu - self.others),
        )
        self.files = SimpleNamespace(line_of_thread=lambda ident: f"robot.py:{ident}")
        self.steps: Iterator[object] = iter(())
        monkeypatch.setattr(hang_detector, "_cpu", lambda: self.cpu)
        monkeypatch.setattr(hang_detector, "_wall", lambda: self.wall)
        monkeypatch.setattr(hang_detector, "_wait", self._wait)
        monkeypatch.setattr(hang_detector, "_exit", self._exit)
        self.detector = HangDetector(self.run, self.files, 10.0, **options)  # type: ignore[arg-type]
        self.interruption = self.detector._interruption
        monkeypatch.setattr(self.interruption, "interrupt", self._interrupt)

    def _wait(self, seconds: float) -> None:
        assert seconds == 0.25
        if next(self.steps, "end") == "end":
            self.interruption.over = True

    def _interrupt(self, ident: int, message: str) -> None:
        self.log.append(f"cpu {self.cpu:g} wall {self.wall:g}: {ident} {message.splitlines()[0]}")

    def _exit(self, code: int) -> None:
        self.log.append(f"exit {code}")

    def watch(self, steps: Iterator[object]) -> list[str]:
        """Let the detector look once for each step."""
        self.steps = steps
        self.detector._watch()
        return self.log


def test_code_that_computes_while_robot_time_stands_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)

    def steps() -> Iterator[object]:
        for world.cpu in (5.0, 9.0):
            yield 1
        world.run.clock.now_us = 20_000  # it moves: the count restarts
        yield 1
        for world.cpu in (18.5, 19.0):
            yield 1
        for world.cpu in (25.0, 28.5):
            yield 1

    assert world.watch(steps()) == [
        "cpu 19 wall 0: 11 robot.py:11: the robot code hangs here: robot time has stood at 1.50 s "
        "through 10 s of computing."
    ]


def test_it_is_interrupted_again_and_ended_only_with_a_crash_log(monkeypatch: pytest.MonkeyPatch) -> None:
    def steps(world: World) -> Iterator[object]:
        for world.cpu in (10.0, 15.0, 20.0):
            yield 1

    world = World(monkeypatch)
    assert [entry.partition(":")[0] for entry in world.watch(steps(world))] == ["cpu 10 wall 0", "cpu 20 wall 0"]
    words: list[str] = []
    stuck: list[tuple[float, object]] = []
    faults = SimpleNamespace(dump_traceback_later=lambda seconds, exit, file: stuck.append((seconds, file)))
    monkeypatch.setattr(hang_detector, "faulthandler", faults)
    world = World(monkeypatch, log=SimpleNamespace(write=words.append, descriptor=7))
    world.watch(steps(world))
    assert world.log[1] == f"exit {EXIT_HANGS}"
    assert words[0].startswith("robot.py:11: the robot code hangs here")
    assert words[0].endswith("A loop that waits for something must wait(), sleep or return.")
    assert set(stuck) == {(60.0, 7)}


def test_code_that_is_blocked_has_a_minute_of_wall_time(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)

    def steps() -> Iterator[object]:
        for world.wall in (30.0, 59.9, 60.0):
            yield 1

    assert world.watch(steps()) == [
        "cpu 0 wall 60: 11 robot.py:11: the robot code is blocked here: robot time has stood at 1.50 s for 60 s, "
        "waiting for the world outside."
    ]
    # One that gets little of a busy machine's processor is not blocked.
    world = World(monkeypatch)

    def busy() -> Iterator[object]:
        for world.wall in (30.0, 60.0, 90.0):
            world.cpu += 0.4
            yield 1

    assert world.watch(busy()) == []
    # Another thread that is always a little busy, such as a library's, does not hide it.
    world = World(monkeypatch)

    def beside_others() -> Iterator[object]:
        for world.wall in (30.0, 60.0):
            world.cpu = world.others = 0.04 * world.wall
            yield 1

    assert [entry.partition(": 11")[0] for entry in world.watch(beside_others())] == ["cpu 2.4 wall 60"]


def test_while_the_robots_code_does_not_run_nothing_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)

    def steps() -> Iterator[object]:
        world.run.in_motion = False
        world.cpu = 50.0
        yield 1
        world.run.in_motion = True
        world.cpu = 59.0
        yield 1

    assert world.watch(steps()) == []


def test_the_thread_whose_turn_it_is_is_the_one_that_hangs(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    world.run.threads.running = SimpleNamespace(ident=22)

    def steps() -> Iterator[object]:
        world.cpu = 10.0
        yield 1

    assert world.watch(steps())[0].startswith("cpu 10 wall 0: 22 robot.py:22: a thread of the robot hangs here")
    world.run.threads.running = SimpleNamespace(ident=None)
    assert world.detector._culprit() == DRIVER


@pytest.mark.parametrize("thread", [False, True], ids=["the main thread", "another"])
def test_an_interruption_raises_in_the_code_that_hangs(thread: bool) -> None:
    interruption = hang_detector._Interruption()
    caught: list[str] = []
    ready = threading.Event()

    def hangs() -> None:
        try:
            with interruption.possible():
                ready.set()
                for _ in range(10**9):
                    pass
        except TestFroze as froze:
            caught.append(str(froze))

    def interrupts(ident: int | None) -> None:
        assert ready.wait(60)
        interruption.interrupt(ident or 0, "it hangs")

    if thread:
        hanging = threading.Thread(target=hangs)
        hanging.start()
        interrupts(hanging.ident)
        hanging.join(60)
    else:
        helper = threading.Thread(target=interrupts, args=(threading.main_thread().ident,))
        helper.start()
        hangs()
        helper.join(60)
    assert caught == ["it hangs"]


def test_an_interruption_that_comes_too_late_does_nothing() -> None:
    interruption = hang_detector._Interruption()
    with interruption.possible():
        interruption.end()
    interruption.interrupt(
        threading.main_thread().ident or 0, "it would end this process by a signal without a handler"
    )


def test_what_the_project_computes_while_it_is_imported_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted: list[str] = []
    monkeypatch.setattr(
        hang_detector._Interruption, "interrupt", lambda self, ident, message: interrupted.append(message)
    )
    cpu = iter(float(number) for number in range(10_000))
    monkeypatch.setattr(hang_detector, "cpu_of_this_thread", lambda: lambda: next(cpu))
    for ours, expected in ((False, []), (True, ["the robot code hangs here, through 0.01 s of computing"])):
        looks: list[str] = []

        def is_project_file(filename: str, ours: bool = ours, looks: list[str] = looks) -> bool:
            looks.append(filename)
            return ours

        with importing(SimpleNamespace(is_project_file=is_project_file), 0.01):  # type: ignore[arg-type]
            while len(looks) < 3:
                threading.Event().wait(0.001)
        assert interrupted[:1] == expected
    assert "pyfrc import hang detector" not in {thread.name for thread in threading.enumerate()}


def test_an_import_that_goes_on_is_interrupted_again_only_after_as_much_time(monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted: list[float] = []
    now = [0.0]
    monkeypatch.setattr(
        hang_detector._Interruption, "interrupt", lambda self, ident, message: interrupted.append(now[0])
    )

    def cpu() -> float:
        now[0] += 0.004
        return now[0]

    monkeypatch.setattr(hang_detector, "cpu_of_this_thread", lambda: cpu)
    with importing(SimpleNamespace(is_project_file=lambda filename: True), 0.01):  # type: ignore[arg-type]
        while len(interrupted) < 3:
            threading.Event().wait(0.001)
    assert [round(each, 6) for each in interrupted[:3]] == [0.016, 0.028, 0.04]
