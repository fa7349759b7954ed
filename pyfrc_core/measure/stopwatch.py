"""Time functions, and find the functions that made the robot's loop overrun its period.

A function's time is the processor time of its thread, and the robot time that passes while it waits (`wpilib.wait`,
`time.sleep`, a lock). Neither depends on what else this computer does. Overruns are found by wall time instead, so that
code that waits for something outside of the program (a file, a socket) is found, too.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial, wraps
from inspect import CO_VARARGS, CO_VARKEYWORDS
from os import environ
from threading import get_ident
from time import perf_counter_ns, thread_time_ns
from types import FrameType, FunctionType
from typing import Any, NamedTuple

from wpilib import TimedRobot

from ..compat.cpython_private import get_frame
from ..hal import modes
from ..project.robot_files import RobotFiles
from ..runtime.patches.install import patches
from ..runtime.threads.robot_threads import RobotThread, RobotThreads
from .figures import CodeLine, Figures, Measurand, Overrun

#: Calls that take longer are stored until the loop's iteration is over, since they may be the cause of an overrun.
_LONG_NS = 5_000_000
#: The names of the wrappers below.
_TIMED = ("timed", "timed_method", "timed_loop")

#: The loop of a robot; the functions that it calls are timed separately.
WHOLE_LOOP = Measurand("loop", "the whole loop", "")


class _Call(NamedTuple):
    """A long call, and its thread."""

    what: Measurand
    begin_ns: int
    took_ns: int
    thread: int


class _Wait(NamedTuple):
    """A wait of a thread.

    :param excess_ns: how much longer it took in wall time than in robot time
    :param computed_ns: the processor time of its thread, which may run the clock meanwhile
    """

    begin_ns: int
    excess_ns: int
    computed_ns: int
    robot_ns: int


class _Begun(NamedTuple):
    """When an iteration of a robot's own loop began: in wall time, in processor time, and after how many waits."""

    wall_ns: int
    computed_ns: int
    waits: int


class Stopwatch:
    """The timed functions of this process."""

    def __init__(self, figures: Figures, files: RobotFiles) -> None:
        self._figures = figures
        self._files = files
        #: Counts the waits of all threads.
        self.waits = 0
        #: The number of calls in progress, in all threads.
        self.calls = 0
        self._waited: dict[int, deque[_Wait]] = {}
        self._long: deque[_Call] = deque(maxlen=64)
        self._record_turn = figures.times_of(WHOLE_LOOP).append
        #: For a robot with its own loop: the end of its last wait.
        self._turn: _Begun | None = None
        self._own_loop: RobotThread | None = None
        self._has_turns = False

    def clear(self) -> None:
        """Delete all measurements, in a fork."""
        self.calls = 0
        self._waited.clear()
        self._long.clear()
        self._turn = None

    # -- functions ------------------------------------------------------------------------------------------------

    def timed(self, function: Callable[..., Any], what: Measurand, period_ns: int | None = None) -> Callable[..., Any]:
        """Return the function with timing for each of its calls.

        :param period_ns: the period, if it is a loop
        """
        now, computed, unusual, watch = perf_counter_ns, thread_time_ns, self._unusual, self
        record = self._figures.times_of(what).append
        long_ns = min(_LONG_NS, period_ns or _LONG_NS)

        def timed_loop() -> Any:
            __tracebackhide__ = True
            waits = watch.waits
            watch.calls += 1
            begin, begin_computed = now(), computed()
            try:
                return function()
            finally:
                spent, took = computed() - begin_computed, now() - begin
                watch.calls -= 1
                if took > long_ns or watch.waits != waits:
                    spent = watch._iteration_ended(what, begin, took, spent, period_ns or 0)
                record(spent)

        # These two are called most often, so they are as short as possible; the second avoids packing arguments.
        def timed(*args: Any, **kwargs: Any) -> Any:
            __tracebackhide__ = True
            waits = watch.waits
            watch.calls += 1
            begin, begin_computed = now(), computed()
            try:
                return function(*args, **kwargs)
            finally:
                spent, took = computed() - begin_computed, now() - begin
                watch.calls -= 1
                if took > long_ns or watch.waits != waits:
                    _, spent = unusual(what, begin, took, spent)
                record(spent)

        def timed_method(self: object) -> Any:
            __tracebackhide__ = True
            waits = watch.waits
            watch.calls += 1
            begin, begin_computed = now(), computed()
            try:
                return function(self)
            finally:
                spent, took = computed() - begin_computed, now() - begin
                watch.calls -= 1
                if took > long_ns or watch.waits != waits:
                    _, spent = unusual(what, begin, took, spent)
                record(spent)

        wrapper: Callable[..., Any] = timed_method if _takes_one_argument(function) else timed
        if period_ns is not None:
            wrapper = timed_loop
        try:
            return wraps(function)(wrapper)
        except (AttributeError, TypeError):  # a callable object that is not a function
            return wrapper

    def timed_whole_loop(self, function: Callable[..., Any], period_ns: int) -> Callable[..., Any]:
        """Return the body of the robot's loop with timing."""
        self._figures.period_ns = period_ns
        return self.timed(function, WHOLE_LOOP, period_ns)

    def _unusual(self, what: Measurand, begin: int, took: int, spent: int) -> tuple[int, int]:
        """Handle a call that took long, or waited.

        :param took: its wall time
        :param spent: the processor time of its thread
        :return: both, with the robot time of its waits instead of what these took here
        """
        excess_ns, computed_ns, robot_ns = self._waited_since(begin)
        took -= excess_ns
        if took > _LONG_NS:
            self._long.append(_Call(what, begin, took, get_ident()))
        return took, spent - computed_ns + robot_ns

    def _iteration_ended(self, what: Measurand, begin: int, took: int, spent: int, period_ns: int) -> int:
        """Handle an iteration of a loop in the same way, and record an overrun; return how long it took by `spent`."""
        _, _, robot_ns = self._waited_since(begin)
        took, spent = self._unusual(what, begin, took, spent)
        held_up_ns = max(0, took - spent)
        within = [call for call in self._long if call.thread == get_ident() and call.begin_ns >= begin]
        if what is WHOLE_LOOP:
            self._long.clear()
        if took > period_ns and patches.run is not None:
            # The innermost function ends first.
            culprit = next((call for call in within if call.took_ns >= took / 2), _Call(what, begin, took, 0))
            began = patches.run.clock.now - robot_ns / 1e9
            test = environ.get("PYTEST_CURRENT_TEST", "").rpartition(" (")[0]
            self._figures.overruns.append(
                Overrun(began, modes.get_mode(), culprit.what, took, culprit.took_ns, held_up_ns, period_ns, test)
            )
        return spent

    def _waited_since(self, begin: int) -> tuple[int, int, int]:
        """Return the sums of the calling thread's waits: excess of wall time, processor time, and robot time."""
        excess_ns = computed_ns = robot_ns = 0
        for wait in reversed(self._waited.get(get_ident(), ())):
            if wait.begin_ns < begin:
                break
            excess_ns += wait.excess_ns
            computed_ns += wait.computed_ns
            robot_ns += wait.robot_ns
        return excess_ns, computed_ns, robot_ns

    # -- waits ----------------------------------------------------------------------------------------------------

    def waiting(self, original: Callable[..., object]) -> Callable[..., Any]:
        """Wrap a method of `RobotThreads` in which the calling thread waits."""

        def wait(threads: RobotThreads, *args: object) -> Any:
            __tracebackhide__ = True
            # The quick check comes first: a notifier, or a loop between two iterations, waits often.
            if self.calls and _in_timed_call(get_frame(1)):
                return self._call_waits(get_frame(1), threads, partial(original, threads, *args))
            if self._is_own_loop():
                return self._own_loop_waits(partial(original, threads, *args))
            return original(threads, *args)

        return wait

    def _call_waits(self, frame: FrameType, threads: RobotThreads, original: Callable[[], object]) -> Any:
        __tracebackhide__ = True
        begin, begin_computed, robot_us = perf_counter_ns(), thread_time_ns(), threads.clock.now_us
        try:
            return original()
        finally:
            robot_ns = (threads.clock.now_us - robot_us) * 1000
            computed_ns = thread_time_ns() - begin_computed
            wait = _Wait(begin, perf_counter_ns() - begin - robot_ns, computed_ns, robot_ns)
            self.waits += 1
            self._waited.setdefault(get_ident(), deque(maxlen=4096)).append(wait)
            line = innermost_line(frame, self._files)
            if line is not None:
                self._figures.on_line(line, 0, robot_ns)

    def _is_own_loop(self) -> bool:
        run = patches.run
        own_loop = run.own_loop if run is not None else None
        if run is None or own_loop is None or own_loop.ident != get_ident():
            return False
        if own_loop is not self._own_loop:  # the loop of a `TimedRobot` is a timed function
            self._own_loop, self._has_turns = own_loop, not isinstance(run.robot, TimedRobot)
            if self._has_turns:
                self._figures.period_ns = round(getattr(run.robot, "control_loop_wait_time", 0.02) * 1e9)
        return self._has_turns

    def _own_loop_waits(self, original: Callable[[], object]) -> Any:
        """Record an iteration of a robot with its own loop: it ends with the loop's first wait."""
        __tracebackhide__ = True
        if self._turn is not None:
            begin, begin_computed, waits = self._turn
            spent, took = thread_time_ns() - begin_computed, perf_counter_ns() - begin
            if took > _LONG_NS or waits != self.waits:
                spent = self._iteration_ended(WHOLE_LOOP, begin, took, spent, self._figures.period_ns)
            self._record_turn(spent)
        try:
            return original()
        finally:
            self._turn = _Begun(perf_counter_ns(), thread_time_ns(), self.waits)


def innermost_line(frame: FrameType | None, files: RobotFiles) -> CodeLine | None:
    """Return the innermost line of the robot's code in this stack, or None."""
    while frame is not None:
        code = frame.f_code
        if files.is_robot_code(code.co_filename):
            name = getattr(code, "co_qualname", code.co_name)  # since Python 3.11
            return CodeLine(f"{files.relative(code.co_filename)}:{frame.f_lineno}", name)
        frame = frame.f_back
    return None


def is_waiting(frame: FrameType | None, files: RobotFiles) -> bool:
    """Return whether the robot's innermost line waits: then other threads run."""
    while frame is not None and not files.is_robot_code(frame.f_code.co_filename):
        if frame.f_code.co_filename == __file__ and frame.f_code.co_name == "wait":
            return True
        frame = frame.f_back
    return False


def _in_timed_call(frame: FrameType | None) -> bool:
    while frame is not None:
        code = frame.f_code
        if code.co_name in _TIMED and code.co_filename == __file__:
            return True
        frame = frame.f_back
    return False


def _takes_one_argument(function: Callable[..., object]) -> bool:
    """Return whether the function is a method without arguments, as most of a robot's are."""
    if not isinstance(function, FunctionType):
        return False
    code = function.__code__
    varying = code.co_flags & (CO_VARARGS | CO_VARKEYWORDS)
    return code.co_varnames[:1] == ("self",) and code.co_argcount == 1 and not code.co_kwonlyargcount and not varying
