"""The clock: what is due, in which order, and how far time goes."""

from __future__ import annotations

import pytest
from hal.simulation import stepTiming
from wpilib import RobotController

from pyfrc_core.runtime.clock import (
    CHECK,
    INPUT,
    MEASURED,
    OBSERVE,
    PACKET,
    PACKET_US,
    PHYSICS,
    ROBOT_LOOP,
    WAKE_UP,
    Clock,
    to_us,
)
from pyfrc_core.runtime.exceptions import TestEnded, TestRanTooLong

from .timeline import Timeline


def test_what_is_due_together_happens_by_rank_and_then_first_in_first_out(timeline: Timeline) -> None:
    for rank, what in (
        (OBSERVE, "observe"),
        (PHYSICS, "physics"),
        (ROBOT_LOOP, "loop"),
        (WAKE_UP, "wake-up 1"),
        (WAKE_UP, "wake-up 2"),
        (INPUT, "input"),
    ):
        timeline.at(20, rank, what)
    timeline.at(19.999, OBSERVE, "just before")
    timeline.clock.before_packet.append(lambda now: timeline.note(f"step at {now}"))
    timeline.clock.deliver_packet = lambda: timeline.note("packet")
    assert timeline.run_until(39.999) == [
        "19.999 just before",
        "20 input",
        "20 step at 0.02",
        "20 packet",
        "20 wake-up 1",
        "20 wake-up 2",
        "20 loop",
        "20 physics",
        "20 observe",
    ]
    assert timeline.clock.next_packet_us == 40_000


def test_packets_come_every_20_ms_for_ever(timeline: Timeline) -> None:
    timeline.clock.deliver_packet = lambda: timeline.note("packet")
    assert timeline.run_until(60) == ["20 packet", "40 packet", "60 packet"]
    assert timeline.clock.next_packet_us == 80_000
    assert PACKET_US == 20_000
    assert tuple(sorted(range(8))) == (INPUT, PACKET, WAKE_UP, ROBOT_LOOP, CHECK, PHYSICS, MEASURED, OBSERVE)


def test_what_recurs_keeps_its_period_whatever_its_action_takes(timeline: Timeline) -> None:
    def slow() -> None:
        timeline.note("begins")
        timeline.clock.run_until(timeline.clock.now_us + 7_000)

    timeline.run_until(3)
    timeline.clock.every(10_000, PHYSICS, slow)
    timeline.run_until(34)
    assert timeline.log == ["13 begins", "23 begins", "33 begins"]


def test_what_recurs_goes_on_after_a_reset_and_not_after_forgetting(timeline: Timeline) -> None:
    clock = timeline.clock
    clock.every(5_000, OBSERVE, lambda: timeline.note("observe"))
    timeline.at(8, OBSERVE, "once")
    timeline.run_until(7)
    clock.initialize()
    assert (clock.now, clock.now_us, clock.next_packet_us, clock.halted) == (0.0, 0, 20_000, False)
    timeline.run_until(9)
    assert timeline.log == ["5 observe", "5 observe"]
    clock.forget()
    timeline.run_until(30)
    assert timeline.log == ["5 observe", "5 observe"]


def test_what_was_due_in_the_past_happens_at_once_and_time_never_goes_back(timeline: Timeline) -> None:
    clock = timeline.clock
    timeline.run_until(10)
    timeline.at(4, ROBOT_LOOP, "late")
    clock.run_until(10_000)
    clock.run_until(2_000)
    assert timeline.log == ["10 late"]
    assert clock.now_us == 10_000


def test_an_action_may_let_time_pass_and_the_clock_is_later_then(timeline: Timeline) -> None:
    timeline.at(12, PHYSICS, "physics")

    def sleeps() -> None:
        timeline.note("sleeps")
        timeline.clock.run_until(15_000)
        timeline.note("is awake")

    timeline.clock.at(10_000, ROBOT_LOOP, sleeps)
    timeline.clock.run_until(11_000)
    assert timeline.log == ["10 sleeps", "12 physics", "15 is awake"]
    assert timeline.clock.now_us == 15_000


def test_the_hal_has_the_same_time(timeline: Timeline) -> None:
    stepTiming(0)
    timeline.run_until(12.345)
    assert RobotController.getFPGATime() == 12_345
    assert timeline.clock.now == 0.012345
    assert timeline.clock.moment[0] == 12_345
    assert Clock().now_us == 0
    assert RobotController.getFPGATime() == 0
    assert (to_us(0.0199996), to_us(1.5)) == (20_000, 1_500_000)


def test_the_time_limit_ends_a_run_at_the_limit_itself(timeline: Timeline) -> None:
    clock = timeline.clock
    assert clock.limit_us == 500_000_000
    clock.limit_us = 30_000
    timeline.at(30, OBSERVE, "at the limit")
    timeline.at(30.001, INPUT, "after it")
    clock.run_until(30_000)
    assert timeline.log == ["30 at the limit"]
    with pytest.raises(TestRanTooLong, match=r"^the robot ran for more than 0\.03 s of robot time, the limit"):
        clock.run_until(30_001)
    with pytest.raises(TestRanTooLong):
        clock.run_while(lambda: True)
    assert timeline.log == ["30 at the limit"]
    assert clock.now_us == 30_000


def test_run_while_stops_with_its_condition_and_at_its_deadline(timeline: Timeline) -> None:
    clock = timeline.clock
    clock.deliver_packet = lambda: timeline.note("packet")
    timeline.at(20, OBSERVE, "observe")
    timeline.at(30, WAKE_UP, "wake-up")
    clock.run_while(lambda: not timeline.log)
    assert timeline.log == ["20 packet"]  # what is due with it waits for its turn
    clock.run_while(lambda: True, deadline_us=30_000)
    assert timeline.log == ["20 packet", "20 observe", "30 wake-up"]
    clock.run_while(lambda: True, deadline_us=35_000)
    assert clock.now_us == 35_000
    clock.run_while(lambda: False, deadline_us=50_000)
    assert clock.now_us == 35_000
    clock.limit_us = 40_000
    clock.run_while(lambda: len(timeline.log) == 3)
    assert timeline.log[3:] == ["40 packet"]


@pytest.mark.parametrize("wait", [lambda clock: clock.run_until(50_000), lambda clock: clock.run_while(lambda: True)])
def test_nothing_passes_once_the_clock_is_halted(wait, timeline: Timeline) -> None:  # type: ignore[no-untyped-def]
    def halt() -> None:
        timeline.note("halt")
        timeline.clock.halted = True

    timeline.clock.at(10_000, WAKE_UP, halt)
    timeline.at(10, ROBOT_LOOP, "loop")
    for _ in range(2):
        with pytest.raises(TestEnded):
            wait(timeline.clock)
        assert timeline.log == ["10 halt"]
    assert timeline.clock.now_us == 10_000
