"""What pyfrc uses of CPython without its promise: what has changed when one of these fails, the message says."""

from __future__ import annotations

import _thread
import queue
import sys
import threading
import time

import pytest

from pyfrc_core.compat import c_calls, cpython_private
from pyfrc_core.compat.private_name import IncompatibleLibraryError, PrivateName
from pyfrc_core.runtime.threads.locks import CooperativeLock


@pytest.mark.parametrize("name", cpython_private.NAMES, ids=lambda name: name.path)
def test_it_is_there(name: PrivateName) -> None:
    try:
        name.find()
    except IncompatibleLibraryError:
        pytest.fail(name.gone)


@pytest.mark.parametrize("name", cpython_private.THREAD_NAMES, ids=lambda name: name.path)
def test_threads_have_it(name: PrivateName) -> None:
    assert hasattr(threading.Thread(), name.name), name.gone


def test_frames() -> None:
    frame = cpython_private.get_frame(0)
    assert frame.f_code.co_name == "test_frames", "sys._getframe(0) is not its caller's frame: it says who calls"
    threads = cpython_private.current_frames()
    assert threads[threading.get_ident()].f_code.co_name == "test_frames", (
        "sys._current_frames() lacks the calling thread's frame: failures name the line that a thread is at by it"
    )


def test_all_locks_inside_threading_come_from_one_name(monkeypatch: pytest.MonkeyPatch) -> None:
    name = cpython_private.ALLOCATE_LOCK
    made: list[object] = []

    def allocate() -> object:
        made.append(_thread.allocate_lock())
        return made[-1]

    monkeypatch.setattr(*name.place, allocate)
    condition = threading.Condition(threading.RLock())
    waiting = threading.Thread(target=lambda: condition.acquire() and condition.wait(0.01))
    waiting.start()
    waiting.join()
    assert made, f"threading.Condition.wait no longer makes its lock by threading._allocate_lock: {name.used_for}"


@pytest.mark.parametrize(
    "name", [cpython_private.THREADING_TIME, cpython_private.QUEUE_TIME], ids=lambda name: name.path
)
def test_time_outs_are_computed_by_it(name: PrivateName, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[float] = []

    def now() -> float:
        asked.append(time.monotonic())
        return asked[-1]

    monkeypatch.setattr(*name.place, now)
    if name is cpython_private.QUEUE_TIME:
        with pytest.raises(queue.Empty):
            queue.Queue[None]().get(timeout=0.001)
    else:
        condition = threading.Condition()
        with condition:
            condition.wait_for(lambda: False, timeout=0.001)
    assert asked, f"time-outs are no longer computed by {name.path}: {name.used_for}"


def test_pythons_own_reentrant_lock() -> None:
    lock = cpython_private.PYTHON_RLOCK.find()()
    assert isinstance(lock._block, cpython_private.LockType), (
        f"threading._PyRLock no longer has its lock in _block: {cpython_private.PYTHON_RLOCK.used_for}"
    )


def test_pythons_own_simple_queue(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = cpython_private.PYTHON_SIMPLE_QUEUE.find()()
    plain.put(1)
    assert plain.get_nowait() == 1
    assert any(isinstance(part, threading.Semaphore) for part in vars(plain).values()), (
        f"queue._PySimpleQueue is no longer made of a semaphore: {cpython_private.PYTHON_SIMPLE_QUEUE.used_for}"
    )


def test_the_robots_lock_has_all_that_pythons_has() -> None:
    missing = {name for name in dir(cpython_private.LockType) if not hasattr(CooperativeLock, name)}
    assert not missing, f"_thread.lock has {missing}, which CooperativeLock has not: code may call it"


def test_threads() -> None:
    thread = threading.Thread(target=test_frames)
    assert cpython_private.is_initialized(thread), cpython_private.THREAD_INITIALIZED.gone
    assert cpython_private.target_of(thread) is test_frames, cpython_private.THREAD_TARGET.gone
    without_init = threading.Thread.__new__(threading.Thread)
    assert not cpython_private.is_initialized(without_init), cpython_private.THREAD_INITIALIZED.used_for


def test_an_exception_in_another_thread() -> None:
    raised: list[BaseException] = []
    running = threading.Event()

    def work() -> None:
        try:
            running.set()
            while True:
                time.sleep(0.001)
        except ZeroDivisionError as error:
            raised.append(error)

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    assert running.wait(60)
    assert thread.ident is not None
    c_calls.raise_in_thread(thread.ident, ZeroDivisionError)
    thread.join(60)
    assert raised, f"PyThreadState_SetAsyncExc raised nothing: {cpython_private.SET_ASYNC_EXCEPTION.used_for}"


def test_what_is_missing_is_an_error_that_says_what_depends_on_it() -> None:
    name = PrivateName("threading:Thread._no_such_name", "the robot stands still without it")
    with pytest.raises(IncompatibleLibraryError) as raised:
        name.find()
    assert str(raised.value).startswith("threading.Thread._no_such_name is gone: the robot stands still without it\n")
    assert f"This pyfrc does not know Python {'.'.join(map(str, sys.version_info[:3]))}" in str(raised.value)
    with pytest.raises(IncompatibleLibraryError, match="wpilib 20"):
        _ = PrivateName("wpilib:NoSuchClass._name", "nothing").place
    with pytest.raises(IncompatibleLibraryError):
        PrivateName("wpilib._no_such_module:name", "nothing").find()
