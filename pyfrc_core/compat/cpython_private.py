"""What pyfrc uses of CPython and its standard library without their promise to keep it.

Some of these are documented in spite of their underscore (`sys._getframe`, the module `_thread`), but not for all
implementations of Python, so they are here too.
"""

from __future__ import annotations

import _thread
import sys
from collections.abc import Callable, Iterator
from threading import Thread
from types import FrameType
from typing import Any

from .private_name import PrivateName

#: Return the frame that is this many calls further out than the caller: 0 is the caller's own.
get_frame: Callable[[int], FrameType] = sys._getframe
#: Return the innermost frame of each thread, by its `ident`.
current_frames: Callable[[], dict[int, FrameType]] = sys._current_frames


def outwards(frame: FrameType | None) -> Iterator[FrameType]:
    """Return a frame and those that have called it, the innermost first."""
    while frame is not None:
        yield frame
        frame = frame.f_back


#: Return a new lock of Python's own. `threading.Lock` is replaced for robot code, this is not.
allocate_lock = _thread.allocate_lock
#: The classes of the built-in locks.
LockType = _thread.LockType
RLockType = _thread.RLock


def start_bare_thread(call: Callable[[], object]) -> None:
    """Call a function in a thread of its own, which nothing waits for.

    `Thread.start` waits until the new thread runs.
    """

    def run() -> None:
        bare_threads.add(_thread.get_native_id())
        call()

    _thread.start_new_thread(run, ())


#: The system's numbers of the threads that `start_bare_thread` has started.
bare_threads: set[int] = set()


PYTHON_RLOCK = PrivateName(
    "threading:_PyRLock",
    "runtime.threads.locks derives the robot's reentrant lock from it, made of a lock (_block)",
)
PYTHON_SIMPLE_QUEUE = PrivateName(
    "queue:_PySimpleQueue", "runtime.threads.locks derives the robot's queue from it, which is made of a semaphore"
)
ALLOCATE_LOCK = PrivateName(
    "threading:_allocate_lock",
    "runtime.threads.locks replaces it, since threading's classes make their locks by it",
)
THREADING_TIME = PrivateName(
    "threading:_time", "runtime.patches.install replaces it, since conditions compute the end of their time-outs by it"
)
QUEUE_TIME = PrivateName(
    "queue:time", "runtime.patches.install replaces it, since queues compute the end of their time-outs by it"
)
THREAD_INITIALIZED = PrivateName(
    "threading:Thread._initialized",
    "runtime.threads.cooperative leaves a thread without it to Thread.start",
)
THREAD_TARGET = PrivateName(
    "threading:Thread._target", "the reason not to fork a process names the function of each of its threads"
)
SET_ASYNC_EXCEPTION = PrivateName(
    "ctypes:pythonapi.PyThreadState_SetAsyncExc", "runtime.checks.hang_detector interrupts a thread that hangs by it"
)

#: Those that are attributes of modules and classes.
NAMES = (PYTHON_RLOCK, PYTHON_SIMPLE_QUEUE, ALLOCATE_LOCK, THREADING_TIME, QUEUE_TIME, SET_ASYNC_EXCEPTION)
#: Those that are attributes of instances.
THREAD_NAMES = (THREAD_INITIALIZED, THREAD_TARGET)


def is_initialized(thread: Thread) -> bool:
    """Return whether `Thread.__init__` was called: a class derived from `Thread` may have left that out."""
    return bool(THREAD_INITIALIZED.of(thread))


def target_of(thread: Thread) -> Callable[..., Any] | None:
    """Return the function that a thread calls; None when it overrides `run`, has ended, or Python does not say."""
    target: Callable[..., Any] | None = getattr(thread, THREAD_TARGET.name, None)
    return target
