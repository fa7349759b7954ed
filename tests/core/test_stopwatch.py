"""The stopwatch of `pyfrc profile`, with given clocks: a wait counts as robot time, and an overrun has its culprit."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.measure import stopwatch
from pyfrc_core.measure.figures import WHOLE_LOOP, Figures, Measurand
from pyfrc_core.measure.stopwatch import Stopwatch
from pyfrc_core.measure.user_functions import UserFunctions
from pyfrc_core.patch_table import PatchTable
from pyfrc_core.project.robot_files import RobotFiles

MS = 1_000_000
TELEOP = Measurand("robot", "MyRobot.teleopPeriodic", "robot.py:3")
PERIOD = 20 * MS


class World:
    """Wall time and processor time, in nanoseconds, and robot time, in microseconds."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.wall = self.computed = 0
        self.clock = SimpleNamespace(now_us=100_000, now=0.1)
        run = SimpleNamespace(clock=self.clock, own_loop=None)
        monkeypatch.setattr(stopwatch, "perf_counter_ns", lambda: self.wall)
        monkeypatch.setattr(stopwatch, "thread_time_ns", lambda: self.computed)
        monkeypatch.setattr(stopwatch, "patches", SimpleNamespace(run=run))
        monkeypatch.setattr(stopwatch, "station", SimpleNamespace(get_mode=lambda: "teleop"))
        monkeypatch.setattr(stopwatch, "environ", {"PYTEST_CURRENT_TEST": "tests/test_a.py::test_teleop (call)"})
        self.figures = Figures()
        self.stopwatch = Stopwatch(self.figures)

    def compute(self, milliseconds: int) -> None:
        self.wall += milliseconds * MS
        self.computed += milliseconds * MS

    def be_held_up(self, milliseconds: int) -> None:
        self.wall += milliseconds * MS

    def sleep(self, robot_milliseconds: int) -> None:
        """Wait in robot time, which takes a millisecond here."""

        def wait(threads: Any) -> None:
            self.wall += MS
            self.computed += MS
            self.clock.now_us += robot_milliseconds * 1000
            self.clock.now += robot_milliseconds / 1000

        self.stopwatch.waiting(wait)(SimpleNamespace(clock=self.clock))

    def run(self, *calls: Callable[[], object]) -> None:
        """Run one turn of the loop, in which the robot's function makes these calls."""
        inner = self.stopwatch.timed(lambda: [call() for call in calls], TELEOP)
        self.stopwatch.timed(inner, WHOLE_LOOP, PERIOD)()


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> World:
    return World(monkeypatch)


def test_what_is_computed_counts_and_what_holds_it_up_does_not(world: World) -> None:
    world.run(lambda: world.compute(3), lambda: world.be_held_up(4))
    assert list(world.figures.times[TELEOP]) == [3 * MS]
    assert world.figures.period_ns == PERIOD
    assert world.figures.overruns == []


def test_a_wait_counts_as_the_robot_time_that_passes(world: World) -> None:
    world.run(lambda: world.compute(2), lambda: world.sleep(500))
    assert list(world.figures.times[TELEOP]) == [502 * MS]
    (overrun,) = world.figures.overruns
    assert (overrun.function, overrun.place, overrun.mode) == (TELEOP.name, TELEOP.place, "teleop")
    assert (overrun.loop_ms, overrun.function_ms, overrun.held_up_ms, overrun.period_ms) == (502, 502, 0, 20)
    assert overrun.robot_time_s == 0.1, "when the turn began"
    assert overrun.test == "tests/test_a.py::test_teleop"
    world.run(lambda: world.compute(30))
    assert world.figures.overruns[1].robot_time_s == pytest.approx(0.6), "without waits before"


def test_an_overrun_by_what_holds_it_up_says_for_how_long(world: World) -> None:
    world.run(lambda: world.compute(4), lambda: world.be_held_up(50))
    (overrun,) = world.figures.overruns
    assert (overrun.loop_ms, overrun.held_up_ms) == (54, 50)


def test_the_loop_itself_is_named_where_no_function_took_half_of_it(world: World) -> None:
    short = world.stopwatch.timed(lambda: world.compute(8), TELEOP)
    world.stopwatch.timed(lambda: [short(), world.compute(14)], WHOLE_LOOP, PERIOD)()
    assert [each.function for each in world.figures.overruns] == [WHOLE_LOOP.name]
    world.stopwatch.timed(lambda: [short(), short(), world.compute(4)], WHOLE_LOOP, PERIOD)()
    assert len(world.figures.overruns) == 1, "20 ms are in time"


def test_a_loop_of_its_own_goes_from_wait_to_wait(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    timed = [False]
    monkeypatch.setattr(stopwatch, "robots", SimpleNamespace(is_timed=lambda robot: timed[0], period=lambda _, s: s))
    run: Any = stopwatch.patches.run
    run.own_loop, run.robot = threading.current_thread(), None
    for milliseconds in (5, 30):
        world.sleep(20)
        world.compute(milliseconds)
    world.sleep(20)
    assert list(world.figures.times[WHOLE_LOOP]) == [5 * MS, 30 * MS]
    assert [(each.loop_ms, each.period_ms) for each in world.figures.overruns] == [(30, 20)]
    timed[0] = True  # its loop is a timed function
    world.sleep(20)
    run.own_loop = threading.Thread()
    world.sleep(20)
    assert len(world.figures.times[WHOLE_LOOP]) == 2


def test_figures_that_are_cleared_keep_their_arrays(world: World) -> None:
    world.run(lambda: world.compute(50))
    times = world.figures.times[TELEOP]
    world.figures.clear()
    assert (len(times), world.figures.overruns) == (0, [])
    assert world.figures.times[TELEOP] is times


def test_what_raises_is_timed_too(world: World) -> None:
    def fail() -> None:
        world.compute(6)
        raise KeyError

    with pytest.raises(KeyError):
        world.stopwatch.timed(fail, TELEOP)()
    assert list(world.figures.times[TELEOP]) == [6 * MS]


def test_a_class_with_a_hook_of_its_own_for_derived_classes_keeps_it(world: World) -> None:
    hooked: list[type] = []

    class Hook:
        def __init_subclass__(cls, **arguments: object) -> None:
            hooked.append(cls)

    class Base: ...

    functions = UserFunctions(world.stopwatch, RobotFiles(Path(__file__).parent), lambda function: function)
    table = PatchTable()
    table.patch(Base, "__init_subclass__", classmethod(functions._when_derived_from(Base)))
    try:

        class Derived(Base, Hook): ...

    finally:
        table.undo()
    assert hooked == [Derived]
