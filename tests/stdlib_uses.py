"""Uses of names of the standard library that pyfrc replaces, which hold in plain Python and so must hold in robot code.

Each `check_` function is one documented use. Run as a program, this prints what failed in plain Python, as JSON.
"""

from __future__ import annotations

import _queue
import _thread
import abc
import asyncio
import concurrent.futures
import copy
import inspect
import json
import logging
import multiprocessing
import pickle
import pkgutil
import queue
import sys
import threading
import time
import timeit
import traceback
import types
import typing
import weakref
from collections.abc import Callable
from decimal import Decimal
from typing import Any, ClassVar
from unittest import mock

LOCK_IS_A_CLASS = sys.version_info >= (3, 13)

#: As a library makes them, for which nothing is replaced.
LIBRARY_LOCK, LIBRARY_RLOCK, LIBRARY_QUEUE = _thread.allocate_lock(), _thread.RLock(), _queue.SimpleQueue()

FUNCTIONS = (
    *("time.sleep", "time.time", "time.time_ns", "time.monotonic", "time.monotonic_ns", "time.perf_counter"),
    *("time.perf_counter_ns", "threading.RLock", "threading.Thread.start", "threading.Thread.join"),
)
EVERYTHING = (*FUNCTIONS, "threading.Lock", "queue.SimpleQueue")


def named(name: str) -> Any:
    return pkgutil.resolve_name(name)


def raises(kind: type[BaseException], call: Callable[[], object]) -> None:
    try:
        call()
    except kind:
        return
    raise AssertionError(f"no {kind.__name__}")


# -- while the module is imported --------------------------------------------------------------------------------------


def work_at_import() -> list[object]:
    done: list[object] = []
    thread = threading.Thread(target=done.append, args=("thread",))
    thread.start()
    raises(RuntimeError, thread.start)
    thread.join()
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        done.append(pool.submit(lambda: "pool").result())
    return done


DONE_AT_IMPORT = work_at_import()


def check_threads_at_import() -> None:
    assert DONE_AT_IMPORT == ["thread", "pool"]


# -- names as objects --------------------------------------------------------------------------------------------------


def check_copies_are_the_same() -> None:
    for name in EVERYTHING:
        assert copy.copy(named(name)) is copy.deepcopy(named(name)) is named(name), name


def check_pickled_by_name() -> None:
    for name in EVERYTHING:
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            assert pickle.loads(pickle.dumps(named(name), protocol)) is named(name), name
            assert pickle.loads(pickle._dumps(named(name), protocol)) is named(name), name  # type: ignore[attr-defined]


def check_names_and_documentation() -> None:
    for name in FUNCTIONS:
        function = named(name)
        module, _, path = name.partition(".")
        assert (function.__module__, function.__qualname__) == (module, path)
        assert function.__name__ == path.rpartition(".")[2]
        assert function.__doc__
        assert callable(function)
        assert inspect.isroutine(function)
    assert threading.Lock.__name__ == ("lock" if LOCK_IS_A_CLASS else "allocate_lock")
    assert threading.Lock.__module__ == "_thread"
    assert repr(threading.Lock) == (
        "<class '_thread.lock'>" if LOCK_IS_A_CLASS else "<built-in function allocate_lock>"
    )
    assert (queue.SimpleQueue.__module__, queue.SimpleQueue.__qualname__) == ("_queue", "SimpleQueue")
    assert repr(time.sleep) == "<built-in function sleep>"
    assert "Simple" in str(queue.SimpleQueue.__doc__)


def check_kinds_of_functions() -> None:
    assert isinstance(time.sleep, types.BuiltinFunctionType)
    assert inspect.isbuiltin(time.monotonic)
    assert isinstance(threading.RLock, types.FunctionType)
    assert isinstance(threading.Thread.start, types.FunctionType)
    assert isinstance(threading.Lock, type) == LOCK_IS_A_CLASS
    assert time.sleep.__self__ is time  # type: ignore[attr-defined]


def check_class_attributes_are_not_bound() -> None:
    class Clock:
        now = time.monotonic
        pause: ClassVar[Any] = time.sleep
        lock = threading.Lock

    assert isinstance(Clock().now(), float)
    assert Clock().now is Clock.now is time.monotonic
    Clock().pause(0.001)
    assert not Clock().lock().locked()


def check_mocks() -> None:
    sleep = mock.create_autospec(time.sleep)
    sleep(1)
    sleep.assert_called_once_with(1)
    real = time.sleep
    with mock.patch("time.sleep", autospec=True) as sleep:
        time.sleep(2)
        sleep.assert_called_once_with(2)
    assert time.sleep is real
    with mock.patch.object(threading, "Lock") as lock:
        threading.Lock()
        lock.assert_called_once_with()
    spec = mock.MagicMock(spec=threading.Lock())
    assert isinstance(spec, type(threading.Lock()))
    raises(AttributeError, lambda: spec.unlock)
    if LOCK_IS_A_CLASS:
        lock = mock.create_autospec(threading.Lock)()
        lock.acquire()
        assert isinstance(lock, threading.Lock)
    mock.create_autospec(queue.SimpleQueue)().put(1)


def check_clocks() -> None:
    assert time.get_clock_info("monotonic").monotonic
    before = time.perf_counter()
    assert before <= timeit.default_timer() <= time.perf_counter()
    raises(TypeError, lambda: time.monotonic(1))  # type: ignore[call-arg]


def check_wrong_times_to_sleep() -> None:
    raises(ValueError, lambda: time.sleep(-1))
    raises(ValueError, lambda: time.sleep(float("nan")))
    raises(OverflowError, lambda: time.sleep(float("inf")))
    for wrong in ("1", None, Decimal("0.001")):
        raises(TypeError, lambda wrong=wrong: time.sleep(wrong))
    time.sleep(False)


# -- locks -------------------------------------------------------------------------------------------------------------


def check_lock_in_annotations() -> None:
    def guarded(lock: typing.Optional[threading.Lock]) -> None: ...  # noqa: UP045 - a function, before 3.13

    hints = typing.get_type_hints(guarded, {"threading": threading, "typing": typing})
    assert hints["lock"] == typing.Optional[threading.Lock]  # noqa: UP045
    if LOCK_IS_A_CLASS:
        assert typing.get_args(eval("threading.Lock | None")) == (threading.Lock, type(None))
    else:
        raises(TypeError, lambda: eval("threading.Lock | None"))


def check_lock_instances() -> None:
    for lock in (threading.Lock(), LIBRARY_LOCK, _thread.allocate_lock()):
        assert isinstance(lock, _thread.LockType)
        assert isinstance(lock, type(threading.Lock()))
        assert isinstance(lock, type(LIBRARY_LOCK))
        assert lock.__class__ is _thread.LockType
    assert not isinstance(threading.RLock(), type(threading.Lock()))
    if LOCK_IS_A_CLASS:
        assert all(isinstance(lock, threading.Lock) for lock in (threading.Lock(), LIBRARY_LOCK))
        assert not isinstance(threading.RLock(), threading.Lock)
        assert issubclass(_thread.LockType, threading.Lock)
    else:
        raises(TypeError, lambda: isinstance(LIBRARY_LOCK, threading.Lock))


def check_lock_methods() -> None:
    lock = threading.Lock()
    assert lock.acquire() is True
    assert lock.locked() is True
    assert lock.acquire(False) is False
    assert lock.acquire(blocking=False) is False
    assert lock.acquire(True, 0.001) is False
    assert lock.acquire(timeout=0) is False
    lock.release()
    assert lock.acquire_lock() is True
    assert lock.locked_lock() is True
    lock.release_lock()
    with lock as taken:
        assert taken is True
        assert repr(lock).startswith("<locked _thread.lock object at 0x")
    assert repr(lock).startswith("<unlocked _thread.lock object at 0x")


def check_lock_errors() -> None:
    lock = threading.Lock()
    raises(RuntimeError, lock.release)
    raises(ValueError, lambda: lock.acquire(False, 1))
    raises(ValueError, lambda: lock.acquire(timeout=-2))
    raises(OverflowError, lambda: lock.acquire(timeout=threading.TIMEOUT_MAX * 2))
    raises(TypeError, lambda: lock.acquire(timeout="1"))  # type: ignore[arg-type]
    raises(TypeError, lambda: threading.Lock(1))  # type: ignore[call-arg]
    raises(AttributeError, lambda: setattr(lock, "owner", 1))
    raises(TypeError, lambda: pickle.dumps(lock))
    raises(TypeError, lambda: copy.copy(lock))
    raises(TypeError, lambda: copy.deepcopy(lock))
    raises(TypeError, lambda: type("MyLock", (type(lock),), {}))
    assert not lock.locked()
    assert weakref.ref(lock)() is lock
    assert len({lock, threading.Lock()}) == 2


def check_rlocks() -> None:
    lock = threading.RLock()
    for each in (lock, LIBRARY_RLOCK):
        assert isinstance(each, type(threading.RLock()))
        assert isinstance(each, _thread.RLock)
    assert lock.__class__ is _thread.RLock
    raises(RuntimeError, lock.release)
    assert lock.acquire() is True
    assert lock.acquire() is True
    assert lock.acquire(False) is True
    raises(ValueError, lambda: lock.acquire(False, 1))
    if sys.version_info >= (3, 14):
        assert lock.locked() is True
    taken: list[bool] = []
    thread = threading.Thread(target=lambda: taken.append(lock.acquire(timeout=0.001)))
    thread.start()
    thread.join()
    assert taken == [False]
    for _ in range(3):
        lock.release()
    raises(TypeError, lambda: pickle.dumps(lock))
    raises(TypeError, lambda: copy.copy(lock))
    assert weakref.ref(lock)() is lock
    assert "_thread.RLock object" in repr(lock)


def check_conditions_of_every_lock() -> None:
    for lock in (None, threading.Lock(), threading.RLock(), _thread.RLock()):
        condition, items, got = threading.Condition(lock), [1], []

        def take(condition: Any = condition, items: list[int] = items, got: list[int] = got) -> None:
            with condition:
                assert condition.wait_for(lambda: len(items) > 1)
                got.append(items.pop())

        raises(RuntimeError, condition.notify)
        raises(RuntimeError, condition.wait)
        thread = threading.Thread(target=take)
        thread.start()
        with condition:
            assert not condition.wait(0.001)
            items.append(2)
            condition.notify_all()
        thread.join()
        assert got == [2]


# -- queues, and what is built on locks --------------------------------------------------------------------------------


def check_simple_queues() -> None:
    Ints = queue.SimpleQueue[int]
    assert typing.get_args(Ints) == (int,)
    items = Ints()
    assert isinstance(items, queue.SimpleQueue)
    assert isinstance(items, _queue.SimpleQueue)
    assert isinstance(LIBRARY_QUEUE, queue.SimpleQueue)
    assert issubclass(_queue.SimpleQueue, queue.SimpleQueue)
    assert items.__class__ is _queue.SimpleQueue
    raises(TypeError, lambda: queue.SimpleQueue(1))  # type: ignore[call-arg]
    items.put(1)
    items.put_nowait(2)
    assert (items.qsize(), items.get(), items.get_nowait(), items.empty()) == (2, 1, 2, True)
    raises(queue.Empty, items.get_nowait)
    raises(queue.Empty, lambda: items.get(timeout=0.001))
    raises(ValueError, lambda: items.get(timeout=-1))
    raises(TypeError, lambda: pickle.dumps(items))
    raises(TypeError, lambda: copy.copy(items))
    assert weakref.ref(items)() is items


class Named(queue.SimpleQueue, abc.ABC):  # type: ignore[type-arg]
    def __init__(self, name: str) -> None:
        self.name = name


def check_derived_from_simple_queue() -> None:
    items = Named("tasks")
    items.put(1)
    assert (items.get(), items.name, items.__class__) == (1, "tasks", Named)
    assert isinstance(items, queue.SimpleQueue)
    assert not isinstance(queue.SimpleQueue(), Named)
    assert pickle.loads(pickle.dumps(Named)) is Named


def check_threads() -> None:
    thread = threading.Thread(target=time.sleep, args=(0.001,))
    raises(RuntimeError, thread.join)
    thread.start()
    raises(RuntimeError, thread.start)
    thread.join()
    assert not thread.is_alive()
    raises(RuntimeError, thread.start)
    raises(RuntimeError, threading.current_thread().join)

    class Uninitialised(threading.Thread):
        def __init__(self) -> None: ...

    raises(RuntimeError, Uninitialised().start)
    event = threading.Event()
    timer = threading.Timer(0.001, event.set)
    timer.start()
    assert event.wait()
    timer.join()


def check_pools() -> None:
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        slow, quick = pool.submit(time.sleep, 0.05), pool.submit(time.sleep, 0.001)
        done, _ = concurrent.futures.wait([slow, quick], return_when=concurrent.futures.FIRST_COMPLETED)
        assert quick in done
        assert list(pool.map(abs, [-1, -2])) == [1, 2]
        assert set(concurrent.futures.as_completed([slow, quick])) == {slow, quick}


def check_asyncio() -> None:
    async def work() -> list[object]:
        lock = asyncio.Lock()
        async with lock:
            await asyncio.wait_for(asyncio.sleep(0.001), 60)
        return list(await asyncio.gather(asyncio.to_thread(lambda: 1), asyncio.sleep(0, 2)))

    assert asyncio.run(work()) == [1, 2]


def check_logging() -> None:
    records: list[logging.LogRecord] = []
    handler = logging.Handler()
    handler.emit = records.append  # type: ignore[method-assign]
    logger = logging.Logger("arm")
    logger.addHandler(handler)
    thread = threading.Thread(target=logger.warning, args=("stuck",))
    with handler.lock:  # type: ignore[union-attr]
        logger.warning("slow")
    thread.start()
    thread.join()
    assert [record.getMessage() for record in records] == ["slow", "stuck"]


def check_multiprocessing() -> None:
    context = multiprocessing.get_context()
    with context.Lock() as taken:
        assert taken
    counter = context.Value("i", 0)
    with counter.get_lock():
        counter.value += 1
    assert counter.value == 1
    context.RLock().acquire()
    assert pickle.loads(multiprocessing.reduction.ForkingPickler.dumps(time.monotonic)) is time.monotonic


CHECKS = {name.removeprefix("check_"): value for name, value in list(vars().items()) if name.startswith("check_")}


def failures() -> dict[str, str]:
    """Run all checks; return the traceback of each that failed."""
    failed = {}
    for name, check in CHECKS.items():
        try:
            check()
        except Exception:
            failed[name] = traceback.format_exc()
    return failed


if __name__ == "__main__":
    print(json.dumps(failures()))
