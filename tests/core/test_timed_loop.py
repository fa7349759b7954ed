"""The loop of a `TimedRobot`: what is called when, and what an overrun does to it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from pyfrc_core.runtime.clock import PHYSICS
from pyfrc_core.runtime.time.timed_loop import TimedLoop

from .timeline import Timeline


class Robot:
    """As much of a `TimedRobot` as its loop needs."""

    def __init__(self, timeline: Timeline, turn: Callable[[], object]) -> None:
        self._note = timeline.note
        self._loopFunc = turn

    def robotInit(self) -> None:
        self._note("robotInit")

    def _simulationInit(self) -> None:
        self._note("_simulationInit")

    def getPeriod(self) -> float:
        return 0.02


#: For callbacks that are added when the robot's turns are in the schedule.
ROBOT: Any = None


def make_loop(timeline: Timeline, turn: Callable[[], object] | None = None, start: bool = True) -> TimedLoop:
    """A loop of 20 ms whose overruns are in the log."""
    loop = TimedLoop(
        timeline.clock,
        timeline.clock.now_us,
        lambda: timeline.note("initialized"),
        lambda took_us: timeline.note(f"took {took_us / 1000:g}"),
    )
    if start:
        loop.begin(Robot(timeline, turn or (lambda: timeline.note("loop"))))  # type: ignore[arg-type]
        timeline.log.clear()
        loop.run_in_place()
    return loop


def test_the_robots_initialisation_comes_first_and_then_the_first_turn_after_one_period(timeline: Timeline) -> None:
    loop = make_loop(timeline, start=False)
    robot: Any = Robot(timeline, lambda: timeline.note("loop"))
    loop.add(robot, lambda: timeline.note("of the constructor"), 0.02)
    assert not loop.in_place
    loop.begin(robot)
    assert timeline.log == ["0 robotInit", "0 _simulationInit", "0 initialized"]
    loop.run_in_place()
    assert loop.in_place
    # The loop was added last, and comes before all others.
    assert timeline.run_until(40)[3:] == ["20 loop", "20 of the constructor", "40 loop", "40 of the constructor"]


def test_periods_and_offsets_count_from_the_robots_construction(timeline: Timeline) -> None:
    timeline.run_until(3)
    loop = make_loop(timeline)
    loop.add(ROBOT, lambda: timeline.note("offset"), 0.01, 0.004)
    timeline.run_until(18)
    assert timeline.log == ["17 offset"]
    loop.add(ROBOT, lambda: timeline.note("late"), 0.005)
    assert timeline.run_until(34)[1:] == ["23 loop", "23 late", "27 offset", "28 late", "33 late"]


@pytest.mark.parametrize("period", [0, -0.01, 0.0000001])
def test_a_period_must_be_longer_than_nothing(period: float, timeline: Timeline) -> None:
    with pytest.raises(ValueError, match=r"^addPeriodic: the period must be longer than 0 s, not"):
        make_loop(timeline).add(ROBOT, lambda: None, period)


def test_what_is_no_function_is_no_callback(timeline: Timeline) -> None:
    with pytest.raises(TypeError, match="addPeriodic: the callback is None, not a function: write it without"):
        make_loop(timeline).add(ROBOT, None, 0.02)  # type: ignore[arg-type]


def test_an_overrun_skips_the_periods_that_it_has_missed(timeline: Timeline) -> None:
    durations = iter([0, 50, 0, 20, 20.001, 0])

    def turn() -> None:
        timeline.note("loop")
        if duration := next(durations, 0):
            timeline.sleep(duration)

    make_loop(timeline, turn)
    assert timeline.run_until(200) == [
        "20 loop",
        "40 loop",
        "90 took 50",
        "90 loop",
        "100 loop",
        "120 loop",
        "140.001 took 20.001",
        "140.001 loop",
        "160 loop",
        "180 loop",
        "200 loop",
    ]


def test_callbacks_of_one_turn_follow_each_other_and_one_that_sleeps_is_not_interrupted(timeline: Timeline) -> None:
    def turn() -> None:
        timeline.note("loop")
        timeline.note(f"in turn: {loop.in_turn}")
        timeline.sleep(8)
        timeline.note("loop ends")

    loop = make_loop(timeline, turn)
    loop.add(ROBOT, lambda: timeline.note("often"), 0.005)
    loop.after_calls.append(lambda callback: timeline.note(f"after {callback.period_us}"))
    timeline.at(23, PHYSICS, "physics")
    timeline.run_until(19)
    timeline.log.clear()
    assert not loop.in_turn
    timeline.run_until(35)
    assert timeline.log == [
        "20 loop",
        "20 in turn: True",
        "23 physics",
        "28 loop ends",
        "28 after 20000",
        "28 often",
        "28 after 5000",
        "28 often",
        "28 after 5000",
        "30 often",
        "30 after 5000",
        "35 often",
        "35 after 5000",
    ]
    assert loop.loop_start_us == 35_000


def test_a_loop_that_was_stopped_makes_no_further_call(timeline: Timeline) -> None:
    def turn() -> None:
        timeline.note("loop")
        loop.stopped = timeline.clock.now_us >= 40_000

    loop = make_loop(timeline, turn)
    loop.add(ROBOT, lambda: timeline.note("other"), 0.02)
    assert timeline.run_until(100) == ["20 loop", "20 other", "40 loop"]


def test_a_loop_on_a_thread_of_its_own_makes_the_same_calls(timeline: Timeline) -> None:
    def turn() -> None:
        timeline.note(f"loop {loop.in_turn}")
        if timeline.clock.now_us == 40_000:
            timeline.sleep(25)

    loop = make_loop(timeline, start=False)
    loop.begin(Robot(timeline, turn))  # type: ignore[arg-type]
    timeline.log.clear()
    loop.add(ROBOT, lambda: timeline.note("other"), 0.03)
    timeline.thread("robot", lambda: loop.run_blocking(timeline.threads))
    timeline.run_until(79)
    assert not loop.in_turn
    assert timeline.log == [
        "20 loop True",
        "30 other",
        "40 loop True",
        "65 took 25",
        "65 other",  # it was in the schedule, with the same time, when the loop was put back
        "65 loop True",
    ]
    loop.stopped = True
    assert timeline.run_until(200)[-1].startswith(("80", "65"))


def test_callbacks_that_are_due_at_once_come_in_the_order_of_wpilibs_heap(timeline: Timeline) -> None:
    loop = make_loop(timeline)
    loop.add(ROBOT, lambda: timeline.note("40"), 0.04)
    loop.add(ROBOT, lambda: timeline.note("10"), 0.01, 0.005)
    loop.add(ROBOT, lambda: timeline.note("100"), 0.1)
    # Measured with WPILib's own loop, stepped by 5 ms.
    assert timeline.run_until(200) == [
        *("15 10", "20 loop", "25 10", "35 10", "40 40", "40 loop", "45 10", "55 10", "60 loop", "65 10", "75 10"),
        *("80 40", "80 loop", "85 10", "95 10", "100 100", "100 loop", "105 10", "115 10", "120 40", "120 loop"),
        *("125 10", "135 10", "140 loop", "145 10", "155 10", "160 40", "160 loop", "165 10", "175 10", "180 loop"),
        *("185 10", "195 10", "200 loop", "200 40", "200 100"),
    ]


def test_the_first_turn_follows_an_initialisation_that_waits_for_longer_than_a_period(timeline: Timeline) -> None:
    loop = make_loop(timeline, start=False)
    robot: Any = Robot(timeline, lambda: timeline.note("loop"))
    loop.add(robot, lambda: timeline.note("other"), 0.05)
    robot.robotInit = lambda: timeline.sleep(105)
    loop.begin(robot)
    timeline.log.clear()
    loop.run_in_place()
    assert timeline.run_until(150) == ["105 loop", "105 other", "120 loop", "140 loop", "150 other"]
