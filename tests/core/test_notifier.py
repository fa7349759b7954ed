"""Notifiers: when they go off, and that they do not drift."""

from __future__ import annotations

import gc

import pytest

from pyfrc_core.runtime.patches.season_2026.hal_notifiers import Alarms, Notifier

from .timeline import Timeline


def test_a_periodic_notifier_keeps_to_its_schedule_however_long_its_handler_takes(timeline: Timeline) -> None:
    durations = iter([0, 7, 0, 25, 0, 0, 0])

    def handler() -> None:
        timeline.note("handler")
        timeline.sleep(next(durations))

    notifier = Notifier(handler)
    timeline.run_until(3)
    notifier.startPeriodic(0.010)
    # The fourth takes 25 ms: what was due meanwhile comes late, one after the other; then it is on time again.
    assert timeline.run_until(80)[:8] == [
        "13 handler",
        "23 handler",
        "33 handler",
        "43 handler",
        "68 handler",
        "68 handler",
        "73 handler",
    ]


def test_a_single_notification_comes_once(timeline: Timeline) -> None:
    notifier = Notifier(lambda: timeline.note("once"))
    notifier.startSingle(0.0125)
    assert timeline.run_until(100) == ["12.5 once"]
    notifier.startSingle(0.001)
    assert timeline.run_until(200) == ["12.5 once", "101 once"]


def test_stopping_starting_anew_and_another_handler(timeline: Timeline) -> None:
    notifier = Notifier(lambda: timeline.note("first"))
    notifier.startPeriodic(0.010)
    timeline.run_until(15)
    notifier.stop()
    timeline.run_until(35)
    notifier.setCallback(lambda: timeline.note("second"))
    notifier.startPeriodic(0.004)
    timeline.run_until(40)
    notifier.startSingle(0.001)  # instead of the period
    timeline.run_until(60)
    assert timeline.log == ["10 first", "39 second", "41 second"]
    notifier.startSingle(0.5)
    notifier.startSingle(0.002)  # earlier than it waits for
    assert timeline.run_until(100)[3:] == ["62 second"]


def test_a_notifier_that_is_dropped_is_silent_and_its_thread_ends(timeline: Timeline) -> None:
    notifier = Notifier(lambda: timeline.note("handler"))
    notifier.setName("of the arm")
    notifier.startPeriodic(0.010)
    thread = notifier._thread
    assert thread is not None
    assert (thread.name, thread.daemon) == ("of the arm", True)
    notifier.setName("renamed")
    assert thread.name == "renamed"
    timeline.run_until(10)
    del notifier
    gc.collect()
    assert timeline.run_until(30) == ["10 handler"]
    assert not thread.is_alive()


def test_two_notifiers_due_together_come_in_the_order_in_which_they_were_set(timeline: Timeline) -> None:
    notifiers = [Notifier(lambda name=name: timeline.note(name)) for name in "abc"]  # type: ignore[misc]
    for notifier in reversed(notifiers):
        notifier.startPeriodic(0.010)
    assert timeline.run_until(20) == ["10 c", "10 b", "10 a", "20 c", "20 b", "20 a"]


def test_wrong_handlers_are_refused() -> None:
    with pytest.raises(TypeError, match=r"^Notifier\(handler\): handler must be callable, not int$"):
        Notifier(3)  # type: ignore[arg-type]
    assert Notifier.setHALThreadPriority(True, 40) is True


def test_hal_alarms_go_off_when_set_and_say_when(timeline: Timeline) -> None:
    alarms = Alarms(timeline.threads)
    handle, status = alarms.initialize()
    assert status == 0
    assert handle in alarms
    assert handle - 1 not in alarms
    assert alarms.initialize() == (handle + 1, 0)

    def body() -> None:
        while True:
            time, status = alarms.wait(handle)
            timeline.note(f"{time} {status}")
            if not time:
                return

    timeline.thread("waits", body)
    assert alarms.update(handle, 12_000) == 0
    timeline.run_until(20)
    assert alarms.update(handle, 40_000) == 0
    timeline.run_until(25)
    assert alarms.update(handle, 30_000) == 0  # earlier than what is waited for
    timeline.run_until(35)
    assert alarms.update(handle, 50_000) == 0
    assert alarms.cancel(handle) == 0
    timeline.run_until(60)
    assert alarms.update(handle, 10_000) == 0  # in the past: at once
    timeline.run_until(61)
    assert alarms.stop(handle) == 0
    timeline.run_until(70)
    assert timeline.log == ["12 12000 0", "30 30000 0", "60 60000 0", "61 0 0"]
    alarms.clean(handle)
    assert handle not in alarms


def test_an_alarm_that_is_cleaned_lets_its_thread_go(timeline: Timeline) -> None:
    alarms = Alarms(timeline.threads)
    handle, _ = alarms.initialize()
    timeline.thread("waits", lambda: timeline.note(alarms.wait(handle)))
    timeline.run_until(5)
    alarms.clean(handle)
    assert timeline.run_until(6) == ["5 (0, 0)"]
