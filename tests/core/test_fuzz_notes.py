"""Misbehavior that is noted while a match goes on: what ends a run, and what a saved script ends with."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from pyfrc_core.fuzz.oracle.failure import MisbehaviorError, NotedFailure, failure_of
from pyfrc_core.fuzz.oracle.misbehavior_notes import LastMisbehavior, MisbehaviorNotes
from pyfrc_core.runtime.clock import PACKET_US

FILES: Any = None
LEFT = MisbehaviorError("the motor still runs", "motors_left_running", "robot.py:3", "autonomousPeriodic")
STUCK = MisbehaviorError("the robot is still in teleop mode", "stuck_modes", "robot.py:9", "teleopPeriodic")


def clock_at(now_us: int) -> Any:
    return SimpleNamespace(now_us=now_us)


def test_each_misbehavior_is_noted_once_with_the_packet_in_which_it_was() -> None:
    notes = MisbehaviorNotes(clock_at(40_000), FILES)
    assert not notes.ends_run(LEFT)
    assert not notes.ends_run(LEFT)
    assert notes.found == [NotedFailure(failure_of(LEFT, FILES), 40_000 + PACKET_US)]
    assert notes.ends_run(STUCK), "the program does nothing more"
    ends = MisbehaviorNotes(clock_at(0), FILES, failure_of(LEFT, FILES))
    assert ends.ends_run(LEFT), "it is the one that is looked for"
    assert ends.found == []


def test_a_saved_script_ends_with_the_last_misbehavior_in_it() -> None:
    failed: list[BaseException] = []
    clock, threads = clock_at(0), SimpleNamespace(failure=None, fail=failed.append)
    last = LastMisbehavior(clock, threads, 5 * PACKET_US)  # type: ignore[arg-type]
    clock.now_us = 4 * PACKET_US
    last.after_packet(0.08)
    assert failed == [], "nothing was wrong before"
    clock.now_us = 4 * PACKET_US - 1
    assert not last.ends_run(LEFT)
    last.after_packet(0.06)
    assert failed == [], "the script goes on"
    assert last.ends_run(STUCK)
    clock.now_us = 4 * PACKET_US
    assert last.ends_run(LEFT)
    last.after_packet(0.08)
    assert failed == [LEFT]
    threads.failure = ValueError("the robot's own error comes first")
    last.after_packet(0.08)
    assert failed == [LEFT]
