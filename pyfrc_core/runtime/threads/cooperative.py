"""Locks and threads for robot code: what waits, waits in robot time; everything else is Python's own.

`threading`'s events, conditions, semaphores, barriers and timers, `queue`'s queues and the thread pools of
`concurrent.futures` are all built on its locks (`locks`), so these few replacements carry them all into robot time. For
threads that take no part in a robot run they behave as the originals do.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import FrameType

from ...compat.cpython_private import current_frames, get_frame, is_initialized, outwards
from ..clock import to_us
from .robot_threads import RobotThread, RobotThreads, real_thread_join

_LIBRARY = Path(threading.__file__).parent
# The parts of the standard library that make locks and threads for their callers, and what replaces their names.
_BETWEEN = (
    *(str(_LIBRARY / name) for name in ("threading.py", "queue.py", "concurrent", "sched.py", "contextlib.py")),
    str(Path(__file__).with_name("locks.py")),
)
_ASYNCIO = str(_LIBRARY / "asyncio") + os.sep
# Where a thread of the robot begins, when nothing of the robot's own is on its stack (a pool's worker).
_ROBOT_THREADS = str(Path(__file__).with_name("robot_threads.py"))

real_thread_start = threading.Thread.start


class _RunScope:
    """The threads of the active robot run, if there is one; and the threads that wait for one to begin."""

    def __init__(self) -> None:
        self.threads: RobotThreads | None = None
        self.waiting_to_begin: list[tuple[threading.Thread, Callable[[], object]]] = []
        self.is_robot_code: Callable[[str], bool]
        #: The project's line, as ``robot.py:12``, that a frame is at; None for a frame of other code.
        self.line_of: Callable[[FrameType], str | None]
        self.forget_project()
        self.local = threading.local()

    def forget_project(self) -> None:
        """Take no code for a robot's from now on."""
        self.is_robot_code = lambda filename: False
        self.line_of = lambda frame: None

    def taking_part(self) -> RobotThreads | None:
        """The run's threads, if the calling thread is one of them and not in the middle of starting another."""
        threads = self.threads
        if threads is None or not threads.takes_part() or getattr(self.local, "starting", False):
            return None
        return threads

    def let_waited_for_begin(self) -> None:
        """Start, in real time, the threads that wait for a run to begin: code outside any run waits for one of them."""
        if self.threads is None and self.waiting_to_begin:
            waiting, self.waiting_to_begin = self.waiting_to_begin, []
            for thread, _ in waiting:
                _start_really(thread)


scope = _RunScope()


def start_thread(thread: threading.Thread) -> None:
    """`Thread.start`: a thread that robot code starts gets its turns from the clock; a library's own does not."""
    if scope.threads is None:
        _note_start(thread)
    initialized = is_initialized(thread) and thread.ident is None  # else the real one raises an error
    if initialized and on_behalf_of_robot_code(get_frame(1)):
        start_in_robot_time(thread)
    else:
        if (caller := _past_library(get_frame(1))) is not None and (line := scope.line_of(caller)) is not None:
            vars(thread)["_pyfrc_test"] = line
        _start_really(thread)


def test_that_started(thread: threading.Thread) -> str | None:
    """Return the line of the project's tests that has started a thread, if they have."""
    line: str | None = vars(thread).get("_pyfrc_test")
    return line


def start_in_robot_time(thread: threading.Thread) -> None:
    """Start a thread of the robot; before there is a run (its module is being imported), have it begin with the run."""
    if scope.threads is None:
        if any(waiting is thread for waiting, _ in scope.waiting_to_begin):
            raise RuntimeError("threads can only be started once")
        scope.waiting_to_begin.append((thread, thread.run))
    elif scope.taking_part() is None:
        _start_really(thread)
    else:
        _begin(scope.threads, thread, thread.run)


def on_behalf_of_robot_code(caller: FrameType | None) -> bool:
    """Whether robot code called, be it through the standard library (an event, a timer, a pool of threads)."""
    while (caller := _runner_of_event_loop(caller)) is not None:
        filename = caller.f_code.co_filename
        if scope.is_robot_code(filename) or filename == _ROBOT_THREADS:
            return True
        if not filename.startswith(_BETWEEN):
            if not filename.startswith("<") or filename.startswith("<frozen "):
                return False
            # Generated code (a dataclass's `__init__`) belongs to the module that it was made for, or to its caller.
            module = caller.f_globals.get("__file__")
            if isinstance(module, str):
                return scope.is_robot_code(module)
        caller = caller.f_back
    return False


def _runner_of_event_loop(caller: FrameType | None) -> FrameType | None:
    """Return what runs the event loop that calls, or what calls instead: one loop has one time for all that it runs."""
    if caller is None or not caller.f_code.co_filename.startswith(_ASYNCIO):
        return caller
    *_, outermost = (call for call in outwards(caller) if call.f_code.co_filename.startswith(_ASYNCIO))
    return outermost.f_back


def _past_library(caller: FrameType | None) -> FrameType | None:
    return next((call for call in outwards(caller) if not call.f_code.co_filename.startswith(_BETWEEN)), None)


def is_event_loop_of_robot_code(caller: FrameType) -> bool:
    """Return whether asyncio calls, in a loop that robot code runs."""
    return caller.f_code.co_filename.startswith(_ASYNCIO) and on_behalf_of_robot_code(caller)


def begin_waiting_threads() -> None:
    """Start what robot code started before its run."""
    waiting, scope.waiting_to_begin = scope.waiting_to_begin, []
    for thread, body in waiting:
        if scope.threads is not None:
            _begin(scope.threads, thread, body)


def _note_start(thread: threading.Thread) -> None:
    """Note which line of the project, if any, has a thread started outside a run: a fork would lack the thread."""
    for call in outwards(get_frame(2)):
        # A robot.py that is run as the program has everything on its stack, pytest's plugins too.
        if (line := scope.line_of(call)) is not None and call.f_globals.get("__name__") != "__main__":
            vars(thread)["_pyfrc_started_at"] = line
            return


def threads_of_the_project() -> list[tuple[threading.Thread, str]]:
    """Return the threads that the project has started outside a run, by itself or in a library, and the line of each.

    Threads that pytest, its plugins and other tools keep for themselves are not among them.
    """
    alive = [*(thread for thread, _ in scope.waiting_to_begin), *threading.enumerate()]
    return [(thread, vars(thread)["_pyfrc_started_at"]) for thread in alive if "_pyfrc_started_at" in vars(thread)]


def _begin(threads: RobotThreads, thread: threading.Thread, body: Callable[[], object]) -> None:
    record = threads.start(thread)
    # `run` is what the new thread calls; it stays this until the thread is gone.
    vars(thread)["run"] = partial(threads.run_body, record, body)
    vars(thread)["_pyfrc_record"] = record
    _start_really(thread)


def _start_really(thread: threading.Thread) -> None:
    scope.local.starting = True  # it waits for the new thread's first sign of life, and that in real time
    try:
        real_thread_start(thread)
    finally:
        scope.local.starting = False


def line_of_thread(ident: int | None) -> str | None:
    """Return the project's line that a thread is at, as ``robot.py:12``."""
    calls = outwards(None if ident is None else current_frames().get(ident))
    return next(filter(None, map(scope.line_of, calls)), None)


def record_of(thread: threading.Thread) -> RobotThread | None:
    """What the run knows of this thread, if it is one of the robot's."""
    record: RobotThread | None = vars(thread).get("_pyfrc_record")
    return record


def join_thread(thread: threading.Thread, timeout: float | None = None) -> None:
    """`Thread.join`, in robot time when a robot's thread waits for another."""
    record, threads = record_of(thread), scope.taking_part()
    if record is None or threads is None or record is threads.current():
        scope.let_waited_for_begin()
        return real_thread_join(thread, timeout)
    timeout_us = None if timeout is None else max(0, to_us(timeout))
    threads.wait(record.joiners, lambda: record.finished, timeout_us)
    return None
