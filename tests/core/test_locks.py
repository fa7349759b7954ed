"""The lock that `threading` is built on in robot code: who gets it, when, and what it costs in robot time."""

from __future__ import annotations

import threading

import pytest

from pyfrc_core.runtime.threads.locks import CooperativeLock, CooperativeRLock, CooperativeSimpleQueue, make_lock

from .timeline import Timeline


def test_a_lock_goes_to_who_has_waited_longest(timeline: Timeline) -> None:
    lock = make_lock()

    def body(name: str, hold: float) -> None:
        with lock:
            timeline.note(f"{name} has it")
            timeline.sleep(hold)
        timeline.note(f"{name} has freed it")

    for name, hold in (("a", 10), ("b", 5), ("c", 5)):
        timeline.thread(name, lambda name=name, hold=hold: body(name, hold))  # type: ignore[misc]
    assert timeline.run_until(50) == [
        "0 a has it",
        "10 a has freed it",
        "10 b has it",
        "15 b has freed it",
        "15 c has it",
        "20 c has freed it",
    ]
    assert not lock.locked()


def test_a_time_out_of_0_costs_a_microsecond_so_that_a_loop_of_them_ends(timeline: Timeline) -> None:
    lock = make_lock()
    lock.acquire()

    def polls() -> None:
        tries = 0
        while not lock.acquire(timeout=0):
            tries += 1
        timeline.note(f"{tries} tries")

    def frees() -> None:
        timeline.sleep(0.005)
        lock.release()

    timeline.thread("polls", polls)
    timeline.thread("frees", frees)
    assert timeline.run_until(1) == ["0.005 4 tries"]
    assert lock.acquire(timeout=0) is False  # on the driver, too
    assert timeline.clock.now_us == 1_001


def test_a_time_out_is_robot_time(timeline: Timeline) -> None:
    lock = make_lock()
    assert lock.acquire() is True
    assert lock.acquire(timeout=0.25) is False
    assert timeline.clock.now_us == 250_000
    assert lock.acquire(False) is False
    assert lock.acquire(blocking=False) is False
    assert timeline.clock.now_us == 250_000
    lock.release()
    assert lock.acquire(timeout=0.25) is True
    assert timeline.clock.now_us == 250_000


def test_wrong_arguments_raise_what_pythons_own_lock_raises(timeline: Timeline) -> None:
    lock = make_lock()
    rlock = CooperativeRLock()
    for each in (lock, rlock):
        with pytest.raises(ValueError, match="can't specify a timeout for a non-blocking call"):
            each.acquire(False, 1)
        with pytest.raises(ValueError, match="timeout value must be"):
            each.acquire(True, -2)
        with pytest.raises(OverflowError):
            each.acquire(True, threading.TIMEOUT_MAX * 2)
        assert each.acquire(True, threading.TIMEOUT_MAX) is True
    with pytest.raises(RuntimeError, match="release unlocked lock"):
        make_lock().release()
    with pytest.raises(TypeError, match="not an acceptable base type"):
        type("Mine", (CooperativeLock,), {})


def test_a_lock_of_another_kind_of_thread_waits_in_real_time(timeline: Timeline) -> None:
    lock = make_lock()
    lock.acquire()
    got: list[bool] = []

    def body() -> None:
        got.append(lock.acquire(timeout=0.01))
        got.append(lock.acquire(timeout=10))

    library = threading.Thread(target=body)
    library.start()
    while not got:
        library.join(0.01)
    lock.release()
    library.join(10)
    assert got == [False, True]
    assert timeline.clock.now_us == 0
    assert repr(lock).startswith("<locked _thread.lock object at 0x")
    lock._at_fork_reinit()
    assert repr(lock).startswith("<unlocked _thread.lock object at 0x")


def test_a_reentrant_lock_is_freed_by_its_last_release(timeline: Timeline) -> None:
    lock = CooperativeRLock()

    def body() -> None:
        assert lock.acquire() is True
        assert lock.acquire() is True
        timeline.note("has it twice")
        lock.release()
        timeline.sleep(5)
        lock.release()

    def waits() -> None:
        timeline.note(lock.acquire(timeout=0.002))
        with lock:
            timeline.note("has it")

    timeline.thread("body", body)
    timeline.thread("waits", waits)
    assert timeline.run_until(10) == ["0 has it twice", "2 False", "5 has it"]


def test_a_queue_hands_on_in_order(timeline: Timeline, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pyfrc_core.runtime.threads.locks.on_behalf_of_robot_code", lambda frame: True)
    monkeypatch.setattr(threading, "_allocate_lock", make_lock)
    items = CooperativeSimpleQueue()
    assert isinstance(items, CooperativeSimpleQueue)

    def takes(name: str) -> None:
        timeline.note(f"{name} {items.get()}")

    for name in "ab":
        timeline.thread(name, lambda name=name: takes(name))  # type: ignore[misc]

    def puts() -> None:
        for item in (1, 2):
            timeline.sleep(3)
            items.put(item)

    timeline.thread("puts", puts)
    assert timeline.run_until(10) == ["3 a 1", "6 b 2"]


def test_what_is_made_for_a_library_is_pythons_own(timeline: Timeline) -> None:
    assert type(CooperativeLock()) is type(threading.Lock())
    assert type(CooperativeLock()) is not CooperativeLock
    assert type(CooperativeSimpleQueue()).__module__ == "_queue"
