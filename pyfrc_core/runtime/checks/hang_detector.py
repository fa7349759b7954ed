"""Detects code that hangs: while robot time does not move, it computes for too long, or waits for too long.

The time in which a busy machine did not let the code run is neither, and a look that comes late, since this process or
the machine was stopped, counts as one look. So only the code itself can make a correct robot fail.
"""

from __future__ import annotations

import atexit
import faulthandler
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from types import FrameType

from ...compat.c_calls import raise_in_thread
from ...compat.cpython_private import allocate_lock, current_frames, outwards, start_bare_thread
from ...processes.crash_report import CrashLog
from ...processes.exit import EXIT_HANGS, exit_now, prepare_sudden_exit
from ...processes.standstill import Standstill, StandstillNotice
from ...project.robot_files import RobotFiles
from ..exceptions import TestFroze
from ..patches.active_run import Run, active_run
from ..threads.thread_cpu import ThreadTimes

#: How many times as long the user's own tests may compute: they may have reasons that a robot has not.
_OUTSIDE_FACTOR = 6.0

#: Code that was interrupted has this part of the limit to end.
_UNWINDING = 0.25

#: For how long no Python code may run until C code writes the stack, as a part of the limit, and in seconds at least.
_DUMP_PART, _DUMP_LEAST = 0.35, 1.0

#: The least limit for code that waits, in seconds: devices and networks are slower than processors.
_BLOCKED_SECONDS = 10.0

#: Where the system does not say for how long a thread has waited for a processor: one that has used it for more than
#: this part of a look would have used it for all of it.
_COMPUTING = 0.1

_IMPORT = "<frozen importlib"
_SIGNAL = getattr(signal, "SIGVTALRM", None)  # not on Windows
_wait, _wall = time.sleep, time.monotonic
_get_ident = threading.get_ident


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
            if sys.platform != "win32" and ident == threading.main_thread().ident:
                signal.pthread_kill(ident, signal.SIGVTALRM)  # interrupts a blocking call, too
                return
            # Only a class can be raised in another thread, so the message travels in one.
            members = {"__str__": lambda self: message, "__module__": TestFroze.__module__}
            raise_in_thread(ident, type("TestFroze", (TestFroze,), members))


class HangDetector:
    """Watches the code of this process, from a thread of its own.

    :param hang_seconds: the limit for code that computes, and for code that waits if it is more than 10 s
    :param log: where to write where the code stands, for the process that owns this one, and the explanation before
        the process is ended, when the code cannot be stopped. Without it, the process is never ended
    :param everything: whether code counts, too, that runs while no robot's code does: tests, and what is imported
    :param terminal: the descriptor of the file where to print, without a log, where the code stands
    :param meanwhile: in what, see `Standstill.text`
    """

    def __init__(
        self,
        files: RobotFiles | None,
        hang_seconds: float,
        log: CrashLog | None = None,
        *,
        everything: bool = False,
        terminal: int = 2,
        meanwhile: str = "",
    ) -> None:
        self._files = files
        self._hang_seconds = hang_seconds
        self._blocked_seconds = max(hang_seconds, _BLOCKED_SECONDS)
        self._log = log
        self._everything = everything
        self._terminal = terminal
        self._notice = StandstillNotice(meanwhile)
        self._interruption = _Interruption()
        self._look_seconds = min(0.25, hang_seconds / 4)
        self._steps = 0
        #: How many times as long code outside the robot's may compute.
        self.outside_factor = _OUTSIDE_FACTOR
        #: The thread that is outside the robot's code while no robot runs: by default the one that is watched.
        self.outside: int | None = None
        #: Whether code that hangs is interrupted, and not only named.
        self.judges = True
        #: Whether a debugger has stopped the code.
        self.paused = False
        #: What was raised in the code.
        self.raised: TestFroze | None = None

    def proceed(self) -> None:
        """Note that code outside the robot's has made progress."""
        self._steps += 1

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Watch while this lasts; code that hangs is interrupted with `TestFroze`."""
        self._watched = _get_ident(), ThreadTimes()
        global _active
        with self._interruption.possible():
            before, _active = _active, self
            try:
                start_bare_thread(self._watch)
                yield
            finally:
                _active = before
                self._interruption.end()
                faulthandler.cancel_dump_traceback_later()

    def _watch(self) -> None:
        me = ThreadTimes()
        seen, stood = self._progress(), _Stall()
        while not self._interruption.over:
            self._have_c_code_watch()
            ident, times = self._whose_turn()
            wall, cpu, starved = _wall(), times.cpu(), _sum(times.starved(), me.starved())
            _wait(self._look_seconds)
            if self._interruption.over:
                return
            progress = self._progress()
            if progress != seen or progress is None:
                if stood.seconds:
                    self._report(None)
                seen, stood = progress, _Stall()
                continue
            elapsed, used = _wall() - wall, max(0.0, times.cpu() - cpu)
            stood.seconds += min(elapsed, 2 * self._look_seconds)
            ident, place, imports = self._place(ident, stood)
            # This thread holds Python's lock while it waits for a processor.
            starved_now = _sum(times.starved(), me.starved())
            if starved is not None and starved_now is not None:
                elapsed -= starved_now - starved
            elif used > _COMPUTING * elapsed:
                elapsed = used
            if not imports:
                stood.computed += used
                # The system adds the time of a starved thread when that is over: then it is more than this look.
                stood.waited += min(elapsed - used, 2 * self._look_seconds)
            run = active_run.run
            self._report(Standstill(stood.seconds, place, None if run is None else run.clock.now))
            if self.judges and self._is_too_long(stood):
                self._judge(stood, ident, place)

    def _limit(self, computes: bool) -> float:
        if not computes:
            return self._blocked_seconds
        return self._hang_seconds * (self.outside_factor if self._running is None and self._everything else 1.0)

    def _is_too_long(self, stood: _Stall) -> bool:
        part = 1.0 if self.raised is None else _UNWINDING
        return stood.computed >= part * self._limit(True) or stood.waited >= part * self._limit(False)

    def _judge(self, stood: _Stall, ident: int, place: str) -> None:
        if self.raised is not None:
            self._give_up(str(self.raised))
        self.raised = TestFroze(self._explain(stood, ident, place))
        running = self._running
        if running is not None:
            running.threads.fail(self.raised)  # whatever code catches it
        if self.outside is not None and running is None:
            raise_in_thread(ident, SystemExit)  # ends it without a word
        else:
            self._interruption.interrupt(ident, str(self.raised))
        stood.computed = stood.waited = 0.0

    @property
    def _running(self) -> Run | None:
        """The run whose code is running."""
        run = active_run.run
        return run if run is not None and run.in_motion else None

    def _progress(self) -> object:
        """Return what changes when there is progress; None while no code is watched."""
        if self.paused or "pydevd" in sys.modules or (self._running is None and not self._everything):
            return None
        run = active_run.run
        running = self._running
        return None if running is None else id(running), None if run is None else run.clock.now_us, self._steps

    def _whose_turn(self) -> tuple[int, ThreadTimes]:
        running = self._running  # asked once: the code may stop running meanwhile
        return self._watched if running is None else running.threads.whose_turn()

    def _place(self, ident: int, stood: _Stall) -> tuple[int, str, bool]:
        """Return the thread that stands, the user's line, and whether that imports a library.

        Of the functions that have not returned since the code stands, it is the innermost one: what an endless loop
        calls returns each time.
        """
        if self._running is None and self.outside is not None:
            ident = self.outside
        imports = False
        innermost = frame = current_frames().get(ident)
        stood.calls = [each for each in outwards(frame) if not stood.calls or each in stood.calls]
        line_of = self._files.line_of_frame if self._files is not None else lambda call: None
        for call in outwards(stood.calls[0] if stood.calls else frame):
            if (line := line_of(call)) is not None:
                return ident, line, imports
            imports = imports or call.f_code.co_filename.startswith(_IMPORT)
        known = f"{innermost.f_code.co_filename}:{innermost.f_lineno}" if innermost is not None else "unknown"
        return ident, known, imports

    def _report(self, standstill: Standstill | None) -> None:
        """Write where the code stands, for those who wait for it."""
        if self._log is not None:
            self._log.set_standstill(standstill)
        elif (text := self._notice.look(standstill)) is not None:
            with suppress(OSError):
                os.write(self._terminal, f"{text}\n".encode(errors="replace"))

    def _have_c_code_watch(self) -> None:
        """Have the stack written by C code, which does not need Python's lock, if this thread does not run any more."""
        file: int = self._terminal
        if self._log is not None:
            self._log.forget_stacks()
            file = self._log.descriptor
        with suppress(OSError):
            seconds = max(_DUMP_LEAST, _DUMP_PART * self._hang_seconds)
            faulthandler.dump_traceback_later(seconds, repeat=True, file=file)

    def _explain(self, stood: _Stall, ident: int, place: str) -> str:
        computes = stood.computed >= self._limit(True)
        seconds = f"{self._limit(computes):g} s"
        run, who = active_run.run, "the test"
        if self._running is None and self.outside is not None:
            return (
                f"{place}: a thread that the test has started is still running, {seconds} after the test.\n"
                "End it in the test, or make it a daemon: threading.Thread(..., daemon=True)"
            )
        if self._running is not None and ident != self._running.threads.driver:
            who = "a thread of the robot"
        elif self._files is not None and self._files.is_robot_code(self._files.root + place.rpartition(":")[0]):
            who = "the robot code"
        stands = "," if run is None else f": robot time has stood at {run.clock.now:.2f} s"
        if computes:
            what = f"{who} hangs here{stands} through {seconds} of computing"
            advice = (
                "Is it an endless loop? Write if instead of while: WPILib calls a periodic method, and execute() of a "
                "command, every 20 ms. In a thread of its own, a loop must sleep or wait()."
            )
        else:
            what = f"{who} is blocked here{stands} for {seconds}, waiting for the world outside"
            advice = "Read from sockets, files and the keyboard in a thread of their own, or with a time-out."
        return f"{place}: {what}.\n{advice} If it only takes long: hang_seconds under [tool.pyfrc.test]."

    def _give_up(self, text: str) -> None:
        """End the process: the code caught the interruption, or never ran Python code again."""
        if self._log is None:
            return
        self._log.write(text)
        prepare_sudden_exit()
        exit_now(EXIT_HANGS)


class _Stall:
    """For how long code has stood, in seconds."""

    def __init__(self) -> None:
        self.seconds = 0.0
        #: The parts of it that count: in which it has used a processor, and in which it has not wanted to. What a
        #: library does while it is imported does not count.
        self.computed = self.waited = 0.0
        #: The calls that have not returned since, innermost first.
        self.calls: list[FrameType] = []


def _sum(first: float | None, second: float | None) -> float | None:
    return None if first is None or second is None else first + second


@contextmanager
def not_watched() -> Iterator[None]:
    """Let pyfrc itself wait for a process that it has started, and whose robot is watched there."""
    detector = _active
    if detector is None:
        yield
        return
    detector.paused, before = True, detector.paused
    try:
        yield
    finally:
        detector.paused = before


@contextmanager
def watching_exit(files: RobotFiles, hang_seconds: float) -> Iterator[None]:
    """Watch, at the end of this program, what robot code registers with `atexit` in this context.

    Python 3.12 starts no thread at that time: there, a program that hangs at its end is not interrupted.
    """
    detector = HangDetector(files, hang_seconds, everything=True, meanwhile="the end of the program")
    detector.outside_factor = 1.0
    watching = ExitStack()
    atexit.register(watching.close)  # the last to be registered is the first to be called
    yield
    atexit.register(_begin, watching, detector)


def _begin(watching: ExitStack, detector: HangDetector) -> None:
    with suppress(RuntimeError):
        watching.enter_context(detector.watching())


#: The detector that watches this process.
_active: HangDetector | None = None


@contextmanager
def importing(files: RobotFiles, hang_seconds: float) -> Iterator[None]:
    """While this lasts, the calling thread imports robot code, which is interrupted with `TestFroze` when it hangs.

    :param hang_seconds: the limit for the project's own files; what libraries take while they are imported does not
        count
    """
    if _active is not None:
        _active.proceed()
        before, _active.outside_factor = _active.outside_factor, 1.0
        try:
            yield
        finally:
            _active.outside_factor = before
        return
    detector = HangDetector(files, hang_seconds, everything=True, meanwhile="the import of the robot's code")
    detector.outside_factor = 1.0
    with detector.watching():
        yield
