"""Detects robot code that hangs: robot time does not move while the code uses processor time.

It measures processor time, not wall time, so that a busy machine cannot make a correct robot fail. Code that blocks
without using processor time (it reads from the keyboard) has a long limit of wall time instead, which never applies
while robot time moves.
"""

from __future__ import annotations

import faulthandler
import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from ..compat.cpython_private import allocate_lock, current_frames, raise_in_thread, start_bare_thread
from ..processes.exit import EXIT_HANGS, prepare_sudden_exit
from .exceptions import TestFroze
from .thread_cpu import cpu_of_this_thread

if TYPE_CHECKING:
    from ..processes.crash_report import CrashLog
    from ..project.robot_files import RobotFiles
    from .robot import RobotRun

#: Wall seconds blocked without any processor time, after which robot code counts as hanging, too.
BLOCKED_SECONDS = 60.0

#: How many times `hang_seconds`, in wall time, no Python code at all may run. Even a busy machine lets a thread run
#: once in a minute.
STUCK_FACTOR = 6

_SIGNAL = getattr(signal, "SIGVTALRM", None)  # not on Windows
_wait, _wall, _cpu = time.sleep, time.monotonic, time.process_time
_get_ident = threading.get_ident
_start_thread, _join_thread = threading.Thread.start, threading.Thread.join
_exit = os._exit


class _Interruption:
    """Raises `TestFroze` in code that hangs."""

    def __init__(self) -> None:
        self._message = ""
        #: Whether it comes too late.
        self.over = False
        self._lock = allocate_lock()

    def end(self) -> None:
        """Let no interruption come any more."""
        self.over = True
        with self._lock:  # one that is on its way
            pass
        _wait(0)  # a signal arrives at the end of a system call at the latest, while it still has a handler

    @contextmanager
    def possible(self) -> Iterator[None]:
        """Allow interruptions of the calling thread until the context ends."""
        if _SIGNAL is None or _get_ident() != threading.main_thread().ident:
            yield
            return

        def interrupted(signum: int, frame: FrameType | None) -> None:
            __tracebackhide__ = True
            if self._message and not self.over:
                raise TestFroze(self._message)
            if callable(before):
                before(signum, frame)

        before = signal.signal(_SIGNAL, interrupted)
        try:
            yield
        finally:
            signal.signal(_SIGNAL, before)

    def interrupt(self, ident: int, message: str) -> None:
        """Interrupt a thread, unless it is too late."""
        with self._lock:
            if self.over:
                return
            self._message = message
            if ident == threading.main_thread().ident and _SIGNAL is not None:
                signal.pthread_kill(ident, _SIGNAL)  # interrupts a blocking call, too
                return
            # Only a class can be raised in another thread, so the message travels in one.
            members = {"__str__": lambda self: message, "__module__": TestFroze.__module__}
            raise_in_thread(ident, type("TestFroze", (TestFroze,), members))


@contextmanager
def importing(files: RobotFiles, hang_seconds: float) -> Iterator[None]:
    """While this lasts, the calling thread imports robot code, which is interrupted with `TestFroze` when it hangs.

    :param hang_seconds: processor seconds in the project's own files, after which it does; what libraries take while
        they are imported does not count
    """
    ident, cpu = _get_ident(), cpu_of_this_thread()
    interruption, returned = _Interruption(), allocate_lock()
    returned.acquire()

    def watch() -> None:
        seen, busy = cpu(), 0.0
        while not returned.acquire(timeout=min(0.25, hang_seconds / 4)):
            frame = current_frames().get(ident)
            now = cpu()
            if frame is not None and files.is_project_file(frame.f_code.co_filename):
                busy += now - seen
            seen = now
            del frame  # or what it holds would live on
            if busy >= hang_seconds:
                busy = 0.0
                interruption.interrupt(ident, f"the robot code hangs here, through {hang_seconds:g} s of computing")

    thread = threading.Thread(target=watch, name="pyfrc import hang detector", daemon=True)
    with interruption.possible():
        _start_thread(thread)
        try:
            yield
        finally:
            interruption.end()
            returned.release()
            _join_thread(thread)  # what forks this process next counts its threads


class HangDetector:
    """Watches one robot run from a thread of its own.

    :param hang_seconds: processor seconds without a microsecond of robot time, after which code counts as hanging
    :param log: where the explanation is written before the process is ended, when the code cannot be stopped; also
        the stack of code that keeps Python's lock, so that not even this class gets to run. Without it the process is
        never ended.
    """

    def __init__(
        self,
        run: RobotRun,
        files: RobotFiles | None,
        hang_seconds: float,
        log: CrashLog | None = None,
    ) -> None:
        self._run = run
        self._files = files
        self._hang_seconds = hang_seconds
        self._log = log
        self._interruption = _Interruption()

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Watch while this lasts; code that hangs is interrupted with `TestFroze`."""
        with self._interruption.possible():
            start_bare_thread(self._watch)
            try:
                yield
            finally:
                self._interruption.end()
                if self._log is not None:
                    faulthandler.cancel_dump_traceback_later()

    def _watch(self) -> None:
        clock, interruption, cpu_of_running = self._run.clock, self._interruption, self._run.threads.cpu_of_running
        seen, cpu, own, wall = clock.now_us, _cpu(), cpu_of_running(), _wall()
        warned = False
        while not interruption.over:
            if self._log is not None:
                # From C, and so without Python's lock; put off again each time this thread does get to run.
                faulthandler.dump_traceback_later(
                    STUCK_FACTOR * self._hang_seconds, exit=True, file=self._log.descriptor
                )
            _wait(min(0.25, self._hang_seconds / 4))
            if clock.now_us != seen or not self._run.in_motion or interruption.over:
                seen, cpu, own, wall, warned = clock.now_us, _cpu(), cpu_of_running(), _wall(), False
                continue
            busy = _cpu() - cpu >= self._hang_seconds
            blocked = _wall() - wall >= BLOCKED_SECONDS and cpu_of_running() - own < 0.01 * BLOCKED_SECONDS
            if not (busy or blocked):
                continue
            culprit = self._culprit()
            if warned:
                self._give_up(culprit)
            interruption.interrupt(culprit, self._explain(culprit, busy))
            cpu, own, wall, warned = _cpu(), cpu_of_running(), _wall(), True

    def _culprit(self) -> int:
        """Return the thread that has the turn."""
        running = self._run.threads.running
        if running is not None and running.ident is not None:
            return running.ident
        return self._run.threads.driver

    def _explain(self, ident: int, busy: bool) -> str:
        line = self._files.line_of_thread(ident) if self._files is not None else None
        place = f"{line}: " if line else ""
        where = "a thread of the robot" if ident != self._run.threads.driver else "the robot code"
        stands = f"robot time has stood at {self._run.clock.now:.2f} s"
        if busy:
            what = f"{where} hangs here: {stands} through {self._hang_seconds:g} s of computing"
            advice = "Is it an endless loop? A loop that waits for something must wait(), sleep or return."
        else:
            what = f"{where} is blocked here: {stands} for {BLOCKED_SECONDS:g} s, waiting for the world outside"
            advice = "Read from sockets, files and the keyboard in a thread of their own, or with a time-out."
        return f"{place}{what}.\n{advice}"

    def _give_up(self, ident: int) -> None:
        """End the process: the code caught the interruption, or never ran Python code again."""
        if self._log is None:
            return
        self._log.write(self._explain(ident, busy=True))
        prepare_sudden_exit()
        _exit(EXIT_HANGS)
