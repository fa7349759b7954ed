"""Threads in robot time: whose turn it is, and when."""

from __future__ import annotations

import threading

import pytest

from pyfrc_core.runtime.clock import PACKET, PHYSICS, ROBOT_LOOP, WAKE_UP
from pyfrc_core.runtime.exceptions import TestEnded
from pyfrc_core.runtime.threads import cooperative, fork_obstacles
from pyfrc_core.runtime.threads import robot_threads as threads
from pyfrc_core.runtime.threads.robot_threads import RobotThread

from .timeline import Timeline


def test_threads_take_turns_in_the_order_in_which_they_asked(timeline: Timeline) -> None:
    def body(name: str, milliseconds: float) -> None:
        for _ in range(3):
            timeline.note(name)
            timeline.sleep(milliseconds)
        timeline.note(f"{name} ends")

    timeline.thread("a", lambda: body("a", 10))
    timeline.thread("b", lambda: body("b", 5))
    timeline.note("nothing runs before time moves")
    assert timeline.run_until(30) == [
        "0 nothing runs before time moves",
        "0 a",
        "0 b",
        "5 b",
        "10 a",
        "10 b",
        "15 b ends",
        "20 a",
        "30 a ends",
    ]
    assert timeline.threads.end() == []


def test_a_wake_up_comes_after_the_packet_and_before_the_loop_of_its_time(timeline: Timeline) -> None:
    def body() -> None:
        timeline.sleep(20)
        timeline.note("thread")

    timeline.thread("sleeper", body)
    timeline.at(20, PHYSICS, "physics")
    timeline.at(20, ROBOT_LOOP, "loop")
    timeline.at(20, PACKET, "packet")
    assert timeline.run_until(20) == ["20 packet", "20 thread", "20 loop", "20 physics"]


def test_who_waits_first_for_a_condition_looks_first(timeline: Timeline) -> None:
    ready: list[str] = []
    waiters: list[RobotThread] = []

    def waits(name: str) -> None:
        found = timeline.threads.wait(waiters, lambda: name in ready, None)
        timeline.note(f"{name} {found}")

    for name in "abc":
        timeline.thread(name, lambda name=name: waits(name))  # type: ignore[misc]

    def notify() -> None:
        ready.extend("cab")
        timeline.threads.notify(waiters)

    timeline.clock.at(7_000, WAKE_UP, notify)
    assert timeline.run_until(10) == ["7 a True", "7 b True", "7 c True"]
    assert waiters == []


def test_a_wait_ends_at_its_time_out_or_when_it_is_over_before(timeline: Timeline) -> None:
    ready: list[str] = []
    waiters: list[RobotThread] = []

    def waits(name: str, timeout_us: int | None) -> None:
        timeline.note(f"{name} {timeline.threads.wait(waiters, lambda: name in ready, timeout_us)}")

    ready.append("there already")
    timeline.thread("there already", lambda: waits("there already", None))
    timeline.thread("in time", lambda: waits("in time", 6_000))
    timeline.thread("too late", lambda: waits("too late", 5_000))
    timeline.thread("no time", lambda: waits("no time", 0))
    timeline.clock.at(5_001, WAKE_UP, lambda: (ready.extend(["in time", "too late"]), timeline.threads.notify(waiters)))
    assert timeline.run_until(10) == [
        "0 there already True",
        "0 no time False",
        "5 too late False",
        "5.001 in time True",
    ]
    assert waiters == []


def test_the_driver_waits_for_a_condition_in_the_same_way(timeline: Timeline) -> None:
    ready: list[int] = []
    wait = timeline.threads.wait
    timeline.clock.at(3_000, WAKE_UP, lambda: ready.append(1))
    timeline.clock.at(3_000, ROBOT_LOOP, lambda: timeline.note("loop"))
    waits: list[int] = []
    timeline.threads.before_driver_waits.append(lambda: waits.append(timeline.threads.driver_waits))
    timeline.clock.at(1_000, WAKE_UP, lambda: waits.append(timeline.threads.driver_waits))
    assert wait([], lambda: bool(ready), None) is True
    assert timeline.clock.now_us == 3_000
    assert timeline.log == []  # what is due at the same time waits
    assert wait([], lambda: bool(ready), 5_000) is True
    assert wait([], lambda: False, 2_000) is False
    assert timeline.clock.now_us == 5_000
    assert wait([], lambda: False, 0) is False
    assert timeline.clock.now_us == 5_000
    assert waits == [0, 1, 0, 0]
    assert timeline.threads.driver_waits == 0


def test_a_condition_that_is_met_for_a_moment_only_has_been_met(timeline: Timeline) -> None:
    answers = iter([False, True, False, False])
    assert timeline.threads.wait([], lambda: next(answers), 50_000) is True


def test_a_wake_up_that_comes_too_late_wakes_no_other_wait(timeline: Timeline) -> None:
    ready: list[int] = []
    waiters: list[RobotThread] = []

    def body() -> None:
        timeline.threads.wait(waiters, lambda: bool(ready), 10_000)
        timeline.note("met")
        timeline.sleep(20)  # across the time-out of the wait before
        timeline.note("slept")

    timeline.thread("t", body)
    timeline.clock.at(4_000, WAKE_UP, lambda: (ready.append(1), timeline.threads.notify(waiters)))
    assert timeline.run_until(30) == ["4 met", "24 slept"]


def test_joining_waits_in_robot_time(timeline: Timeline) -> None:
    def short() -> None:
        timeline.sleep(8)
        timeline.note("short ends")

    first = timeline.thread("short", short)

    def joins() -> None:
        cooperative.join_thread(first, 0.003)
        timeline.note(f"still there: {first.is_alive()}")
        cooperative.join_thread(first)
        timeline.note(f"still there: {first.is_alive()}")

    timeline.thread("joins", joins)
    cooperative.join_thread(first, 0.001)
    timeline.note("the driver has waited")
    cooperative.join_thread(first)
    assert timeline.run_until(20) == [
        "1 the driver has waited",
        "3 still there: True",
        "8 short ends",
        "8 still there: False",
    ]


def test_what_a_thread_raises_reaches_the_driver(timeline: Timeline) -> None:
    def fails() -> None:
        timeline.sleep(5)
        raise ValueError("from the thread")

    def leaves() -> None:
        raise SystemExit(3)

    timeline.thread("leaves", leaves)
    timeline.thread("fails", fails)
    timeline.run_until(4)
    with pytest.raises(ValueError, match="from the thread") as caught:
        timeline.run_until(10)
    assert timeline.clock.now_us == 5_000
    assert caught.traceback[-1].name == "fails"


def test_a_failure_while_robot_code_on_the_driver_waits_is_kept_for_whoever_runs_the_robot(timeline: Timeline) -> None:
    def fails() -> None:
        timeline.sleep(5)
        raise ValueError("first")

    timeline.thread("fails", fails)
    with pytest.raises(TestEnded):
        timeline.sleep(10)  # what the robot's own `except` would catch
    assert str(timeline.threads.failure) == "first"
    assert timeline.clock.halted
    timeline.threads.fail(ValueError("second"))
    assert str(timeline.threads.failure) == "first"
    with pytest.raises(TestEnded):
        timeline.sleep(10)
    assert timeline.threads.driver_waits == 0


def test_at_the_end_each_wait_raises(timeline: Timeline) -> None:
    def body(name: str) -> None:
        try:
            timeline.sleep(1_000)
        finally:
            timeline.note(f"{name} unwinds")

    def stubborn() -> None:
        for _ in range(3):
            try:
                timeline.sleep(1_000)
            except TestEnded:
                timeline.note("goes on")

    def never() -> None:
        timeline.note("begins after the end")

    alive = [timeline.thread("a", lambda: body("a")), timeline.thread("b", lambda: body("b"))]
    alive.append(timeline.thread("stubborn", stubborn))
    timeline.run_until(10)
    alive.append(timeline.thread("never", never))
    assert timeline.threads.end() == []
    assert timeline.log == ["10 a unwinds", "10 b unwinds", "10 goes on", "10 goes on", "10 goes on"]
    assert [thread.is_alive() for thread in alive] == [False] * 4
    with pytest.raises(TestEnded):
        timeline.sleep(1)


def test_a_thread_that_never_stops_is_named(timeline: Timeline, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threads, "_TELL_TO_STOP", 10)
    stop: list[bool] = []
    tries: list[int] = []

    def never_stops() -> None:
        while not stop:
            try:
                timeline.sleep(1)
            except TestEnded:
                tries.append(1)

    thread = timeline.thread("never stops", never_stops)
    timeline.run_until(2)
    (left,) = timeline.threads.end()
    assert left.thread is thread
    assert len(tries) == 10
    stop.append(True)
    timeline.threads.end()
    assert not thread.is_alive()


def test_the_clock_goes_on_without_a_thread_that_waits_for_the_outside_world(
    timeline: Timeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(threads, "_LOOK_SECONDS", 0.005)
    outside = threading.Event()

    def body() -> None:
        outside.wait(60)  # a real one: no turn is handed back
        timeline.note("is back")
        timeline.sleep(5)
        timeline.note("is in robot time")

    thread = timeline.thread("outside", body)
    record = cooperative.record_of(thread)
    assert record is not None
    timeline.run_until(20)
    assert record.detached
    assert record.left_alone
    assert timeline.log == []
    outside.set()
    assert record.done.acquire(timeout=10)  # it has parked
    record.done.release()
    timeline.run_until(40)
    assert not record.detached
    assert not thread.is_alive()
    assert timeline.log == ["20 is back", "25 is in robot time"]


def test_a_daemon_thread_in_the_outside_world_is_left_alone_at_the_end(
    timeline: Timeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(threads, "_LOOK_SECONDS", 0.005)
    outside = threading.Event()
    daemon = timeline.thread("daemon", lambda: outside.wait(60))
    other = threading.Thread(target=lambda: outside.wait(60), name="other")
    cooperative.start_in_robot_time(other)
    timeline.run_until(1)
    assert [record.thread for record in timeline.threads.end()] == [other]
    outside.set()
    for thread in (daemon, other):
        thread.join(10)


def test_a_busy_thread_of_a_library_does_not_hide_one_that_waits_for_the_outside_world(
    timeline: Timeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(threads, "_LOOK_SECONDS", 0.005)
    outside, over = threading.Event(), threading.Event()

    def is_busy() -> None:
        while not over.is_set():
            pass

    library = threading.Thread(target=is_busy)
    library.start()
    thread = timeline.thread("outside", lambda: outside.wait(60))
    record = cooperative.record_of(thread)
    assert record is not None
    try:
        timeline.run_until(20)
        assert record.detached
    finally:
        over.set()
        outside.set()
        library.join()
        thread.join(10)


def test_a_thread_that_came_back_from_the_outside_world_stops_at_the_end(
    timeline: Timeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(threads, "_LOOK_SECONDS", 0.005)
    outside = threading.Event()

    def body() -> None:
        outside.wait(60)
        timeline.sleep(5)

    thread = timeline.thread("reads", body)
    record = cooperative.record_of(thread)
    assert record is not None
    timeline.run_until(20)
    assert record.detached
    outside.set()
    assert record.done.acquire(timeout=10)  # it has parked
    record.done.release()
    assert timeline.threads.end() == []
    thread.join(10)
    assert not thread.is_alive()


def test_threads_started_before_a_run_begin_with_it(timeline: Timeline) -> None:
    scope = cooperative.scope
    scope.threads = None
    thread = threading.Thread(target=lambda: timeline.note("runs"), daemon=True)
    cooperative.start_in_robot_time(thread)
    with pytest.raises(RuntimeError, match="threads can only be started once"):
        cooperative.start_in_robot_time(thread)
    assert not thread.is_alive()
    scope.threads = timeline.threads
    timeline.run_until(5)
    assert timeline.log == []
    cooperative.begin_waiting_threads()
    assert scope.waiting_to_begin == []
    assert timeline.run_until(10) == ["5 runs"]


def test_devices_that_an_import_makes_are_a_reason_not_to_fork(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fork_obstacles, "devices_exist", lambda: True)
    monkeypatch.setattr(fork_obstacles, "existing_devices", lambda: ["pwm[3]", "dio[0]"])
    assert "devices are made: pwm[3], dio[0]" in fork_obstacles.reasons_not_to_fork()
