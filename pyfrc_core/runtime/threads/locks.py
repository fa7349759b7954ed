"""Locks and queues for robot code, for which its threads wait in robot time.

A library's own locks stay real: the threads that it shares them with know no robot time. So each name makes the one or
the other, by who calls it, and both count as instances of the same class.
"""

from __future__ import annotations

import queue
import threading
from functools import partial
from typing import Any

from ...compat.cpython_private import ALLOCATE_LOCK, PYTHON_RLOCK, PYTHON_SIMPLE_QUEUE, LockType, RLockType, get_frame
from ...patch_table import Patch
from ..clock import to_us
from .cooperative import join_thread, on_behalf_of_robot_code, scope, start_thread
from .replacements import BuiltinClassReplacement, replaces
from .robot_threads import RobotThread, real_allocate_lock

_real_rlock = threading.RLock
_real_simple_queue = queue.SimpleQueue
_PythonRLock: Any = PYTHON_RLOCK.find()
_PythonSimpleQueue: Any = PYTHON_SIMPLE_QUEUE.find()


@replaces(LockType, "threading:Lock")
class CooperativeLock(BuiltinClassReplacement):
    __slots__ = ("__weakref__", "_lock", "_waiters")

    _lock: LockType
    _waiters: list[RobotThread]

    def __new__(cls) -> Any:
        return make_lock() if on_behalf_of_robot_code(get_frame(1)) else real_allocate_lock()

    def __init_subclass__(cls) -> None:
        raise TypeError("type '_thread.lock' is not an acceptable base type")

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take the lock, and wait for it if it is taken; return whether it was taken."""
        __tracebackhide__ = True
        if timeout != -1 and (not blocking or not 0 <= timeout <= threading.TIMEOUT_MAX):
            return self._lock.acquire(blocking, timeout)  # which raises the error for that
        if self._lock.acquire(False):
            return True
        if not blocking:
            return False
        threads = scope.taking_part()
        if threads is None:
            scope.let_waited_for_begin()
            return self._lock.acquire(True, timeout)
        timeout_us = None if timeout < 0 else max(1, to_us(timeout))  # a wait that takes no time could go on for ever
        return threads.wait(self._waiters, partial(self._lock.acquire, False), timeout_us)

    def release(self) -> None:
        """Free the lock; a lock that is not taken raises `RuntimeError`."""
        self._lock.release()
        if self._waiters and scope.threads is not None:
            scope.threads.notify(self._waiters[:1])  # only one of them can have it

    def locked(self) -> bool:
        """Return whether the lock is taken."""
        return self._lock.locked()

    def __enter__(self) -> bool:
        return self.acquire()

    def __exit__(self, *exc_info: object) -> None:
        self.release()

    acquire_lock, release_lock, locked_lock = acquire, release, locked

    def _at_fork_reinit(self) -> None:
        self._lock = real_allocate_lock()
        self._waiters = []

    def __repr__(self) -> str:
        return f"<{'locked' if self.locked() else 'unlocked'} _thread.lock object at {id(self):#x}>"


def make_lock() -> CooperativeLock:
    """Return a new lock for robot code, for any caller."""
    lock: CooperativeLock = object.__new__(CooperativeLock)
    lock._lock = real_allocate_lock()
    lock._waiters = []
    return lock


def allocate_lock() -> CooperativeLock | LockType:
    """`threading.Lock` where it is a function (before Python 3.13), and what `threading` itself calls."""
    return make_lock() if on_behalf_of_robot_code(get_frame(1)) else real_allocate_lock()


@replaces(RLockType, "_thread:RLock")
class CooperativeRLock(BuiltinClassReplacement, _PythonRLock):  # type: ignore[misc]
    def __init__(self) -> None:
        super().__init__()
        self._block = make_lock()

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        __tracebackhide__ = True
        # Python's own returns 1 instead of True, and takes any time-out, when the caller has the lock already.
        if timeout != -1 and (not blocking or not 0 <= timeout <= threading.TIMEOUT_MAX):
            return real_allocate_lock().acquire(blocking, timeout)  # which raises the error for that
        return bool(super().acquire(blocking, timeout))

    __enter__ = acquire


def new_rlock(*args: object, **kwargs: object) -> Any:
    """`threading.RLock`, which is a function in all versions of Python."""
    if args or kwargs or not on_behalf_of_robot_code(get_frame(1)):
        return _real_rlock(*args, **kwargs)
    return CooperativeRLock()


@replaces(_real_simple_queue, "queue:SimpleQueue")
class CooperativeSimpleQueue(BuiltinClassReplacement, _PythonSimpleQueue):  # type: ignore[misc]
    def __new__(cls, *args: object, **kwargs: object) -> Any:
        if cls is CooperativeSimpleQueue and (args or kwargs or not on_behalf_of_robot_code(get_frame(1))):
            return _real_simple_queue(*args, **kwargs)
        made = super().__new__(cls)
        _PythonSimpleQueue.__init__(made)  # here, since a derived class need not call `__init__`
        return made

    def __init__(self) -> None: ...


def patches() -> list[Patch]:
    """Return the names of `threading` and `queue` to replace."""
    return [
        Patch(*ALLOCATE_LOCK.place, allocate_lock),
        Patch(threading, "RLock", new_rlock),
        Patch(threading.Thread, "start", start_thread),
        Patch(threading.Thread, "join", join_thread),
        Patch(threading, "Lock", CooperativeLock if isinstance(threading.Lock, type) else allocate_lock),
        Patch(queue, "SimpleQueue", CooperativeSimpleQueue),
    ]
