"""WPILib's watchdogs in robot time: when they expire, and what is reported how often."""

from __future__ import annotations

import gc

import hal
import pytest
import wpilib

from pyfrc_core.runtime.clock import PACKET, ROBOT_LOOP
from pyfrc_core.runtime.patches.season_2026.watchdog import Watchdog

from .timeline import Timeline


@pytest.fixture
def messages(timeline: Timeline, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What is reported, with its time."""
    reported: list[str] = []

    def send(is_error: bool, code: int, is_library: bool, details: str, location: str, stack: str, show: bool) -> int:
        assert (code, is_library, stack, show) == (1, False, "", True)
        kind = "error" if is_error else "warning"
        reported.append(f"{timeline.clock.now_us / 1000:g} {kind} at {location}: {details}")
        return 0

    monkeypatch.setattr(hal, "sendError", send)
    return reported


def make(timeline: Timeline, seconds: float = 0.05, what: str = "expired") -> Watchdog:
    return Watchdog(seconds, lambda: timeline.note(what))


def test_one_that_is_not_fed_expires_once(timeline: Timeline, messages: list[str]) -> None:
    dog = make(timeline)
    timeline.run_until(100)
    assert timeline.log == []  # it was not enabled
    dog.enable()
    timeline.run_until(149.999)
    assert not dog.isExpired()
    assert timeline.run_until(300) == ["150 expired"]
    assert dog.isExpired()
    assert messages == ["150 warning at Watchdog: Watchdog not fed within 0.050000s, at 0.150 s"]
    dog.reset()
    assert not dog.isExpired()
    assert timeline.run_until(350) == ["150 expired", "350 expired"]


def test_feeding_puts_off_its_end(timeline: Timeline, messages: list[str]) -> None:
    dog = make(timeline)
    dog.enable()
    for milliseconds in (40, 80, 120):
        timeline.run_until(milliseconds)
        dog.reset()
    assert timeline.run_until(1000) == ["170 expired"]


def test_disabling_and_another_time_out(timeline: Timeline, messages: list[str]) -> None:
    dog = make(timeline)
    dog.enable()
    timeline.run_until(10)
    dog.disable()
    timeline.run_until(100)
    assert timeline.log == []
    dog.setTimeout(0.2)
    dog.enable()
    timeline.run_until(110)
    dog.setTimeout(0.02)  # earlier than the alarm that is set
    assert timeline.run_until(1000) == ["130 expired"]
    dog.setTimeout(0.03)
    assert timeline.run_until(2000) == ["130 expired", "1030 expired"]


def test_it_comes_between_the_packet_and_the_loop(timeline: Timeline, messages: list[str]) -> None:
    make(timeline, 0.02).enable()  # as in WPILib, one that was dropped is silent
    gc.collect()
    dog = make(timeline, 0.02)
    dog.enable()
    timeline.at(20, ROBOT_LOOP, "loop")
    timeline.at(20, PACKET, "packet")
    assert timeline.run_until(20) == ["20 packet", "20 expired", "20 loop"]


def test_what_is_late_again_is_reported_once_a_second(timeline: Timeline, messages: list[str]) -> None:
    silent = make(timeline, 0.3, "silent")
    silent.suppressTimeoutMessage(True)
    dog = Watchdog(0.25, lambda: (timeline.note("expired"), dog.reset()))
    dog.enable()
    silent.enable()
    timeline.run_until(2300)
    assert timeline.log == [
        "250 expired",
        "300 silent",
        *(f"{milliseconds} expired" for milliseconds in range(500, 2251, 250)),
    ]
    assert [message.partition(" ")[0] for message in messages] == ["250", "1250", "2250"]
    silent.suppressTimeoutMessage(False)
    silent.enable()
    timeline.run_until(2700)
    assert messages[-1].startswith("2600 warning at Watchdog: Watchdog not fed within 0.300000s")


def test_outside_a_run_it_never_expires(timeline: Timeline, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.runtime.threads.cooperative.scope.threads", None)
    dog = make(timeline)
    dog.enable()
    timeline.run_until(1000)
    assert timeline.log == []
    assert isinstance(dog, wpilib.Watchdog)


class Robot:
    """As much of a robot as is looked at."""

    def __init__(self, timeline: Timeline) -> None:
        self._note = timeline.note

    def getPeriod(self) -> float:
        return 0.02

    def printWatchdogEpochs(self) -> None:
        self._note("epochs")
