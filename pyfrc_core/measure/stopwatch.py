"""Time functions, and find the functions that made the robot's loop overrun its period.

A function's time is the processor time of its thread, and the robot time that passes while it waits (`wpilib.wait`,
`time.sleep`, a lock). Neither depends on what else this computer does. Overruns are found by wall time instead, so that
code that waits for something outside of the program (a file, a socket) is found, too.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from functools import wraps
from os import environ
from threading import get_ident
from time import perf_counter_ns, thread_time_ns
from typing import Any, NamedTuple

from ..runtime.patches.install import patches
from ..runtime.threads.robot_threads import RobotThreads
from ..wpi import robots, station
from .figures import WHOLE_LOOP, Figures, Measurand, Overrun

#: Calls that take longer are stored until the loop's iteration is over, since they may be the cause of an overrun.
_LONG_NS = 5_000_000


#: What a thread's clocks show, in nanoseconds: wall time, processor time, and the robot time of all its waits.
_Moment = tuple[int, int, int]


class _LongCall(NamedTuple):
    what: Measurand
    begin: _Moment
    took_ns: int


class _Clocks:
    """The clocks of a thread. While it waits, they advance by robot time."""

    def __init__(self) -> None:
        #: The number of its timed calls in progress.
        self.calls = 0
        self.long_calls: deque[_LongCall] = deque(maxlen=64)
        #: When the iteration of its own loop began: at the end of its last wait.
        self.iteration: _Moment | None = None
        self._wall = self._computed = self._waited = 0

    def now(self) -> _Moment:
        return perf_counter_ns() + self._wall, thread_time_ns() + self._computed, self._waited

    def has_waited(self, since: _Moment, robot_ns: int) -> None:
        """Count a wait as the robot time that passed meanwhile, whatever it took here."""
        wall, computed, _ = self.now()
        self._wall += robot_ns - (wall - since[0])
        self._computed += robot_ns - (computed - since[1])
        self._waited += robot_ns


class _CallingThread(threading.local):
    def __init__(self) -> None:
        self.clocks = _Clocks()


class Stopwatch:
    """The timed functions of this process."""

    def __init__(self, figures: Figures) -> None:
        self._figures = figures
        self._thread = _CallingThread()

    def timed(self, function: Callable[..., Any], what: Measurand, period_ns: int = 0) -> Callable[..., Any]:
        """Return the function with timing for each of its calls.

        :param period_ns: the period, if it is a loop
        """
        thread, record, ended = self._thread, self._figures.times_of(what).append, self._ended
        if what is WHOLE_LOOP:
            self._figures.period_ns = period_ns

        def timed(*args: Any, **kwargs: Any) -> Any:
            __tracebackhide__ = True
            clocks = thread.clocks
            clocks.calls += 1
            begin = clocks.now()
            try:
                return function(*args, **kwargs)
            finally:
                record(ended(clocks, what, begin, period_ns))
                clocks.calls -= 1

        try:
            return wraps(function)(timed)
        except (AttributeError, TypeError):  # a callable object that is not a function
            return timed

    def _ended(self, clocks: _Clocks, what: Measurand, begin: _Moment, period_ns: int) -> int:
        """Return the time of a call that has ended now; record an overrun if it was an iteration that took too long."""
        wall, computed, waited = clocks.now()
        took, spent = wall - begin[0], computed - begin[1]
        if took > _LONG_NS:
            clocks.long_calls.append(_LongCall(what, begin, took))
        if period_ns and took > period_ns and patches.run is not None:
            # The innermost function ends first.
            within = (call for call in clocks.long_calls if call.begin >= begin and call.took_ns >= took / 2)
            culprit = next(within, _LongCall(what, begin, took))
            began = patches.run.clock.now - (waited - begin[2]) / 1e9
            test = environ.get("PYTEST_CURRENT_TEST", "").rpartition(" (")[0]
            _, name, place = culprit.what
            nanoseconds = (took, culprit.took_ns, max(0, took - spent), period_ns)
            loop_ms, function_ms, held_up_ms, period_ms = (each / 1e6 for each in nanoseconds)
            self._figures.overruns.append(
                Overrun(
                    round(began, 6), station.get_mode(), name, place, loop_ms, function_ms, held_up_ms, period_ms, test
                )
            )
        return spent

    def waiting(self, original: Callable[..., object]) -> Callable[..., Any]:
        """Wrap a method of `RobotThreads` in which the calling thread waits."""

        def wait(threads: RobotThreads, *args: object) -> Any:
            __tracebackhide__ = True
            clocks = self._thread.clocks
            if clocks.calls:
                begin, robot_us = clocks.now(), threads.clock.now_us
                try:
                    return original(threads, *args)
                finally:
                    robot_ns = (threads.clock.now_us - robot_us) * 1000
                    clocks.has_waited(begin, robot_ns)
            if not self._is_own_loop():
                return original(threads, *args)
            # An iteration of a robot with its own loop begins and ends with a wait.
            if clocks.iteration is not None:
                spent = self._ended(clocks, WHOLE_LOOP, clocks.iteration, self._figures.period_ns)
                self._figures.times_of(WHOLE_LOOP).append(spent)
            try:
                return original(threads, *args)
            finally:
                clocks.iteration = clocks.now()

        return wait

    def _is_own_loop(self) -> bool:
        run = patches.run
        if run is None or run.own_loop is None or run.own_loop.ident != get_ident():
            return False
        if robots.is_timed(run.robot):  # its loop is a timed function
            return False
        self._figures.period_ns = round(robots.period(run.robot, 0.02) * 1e9)
        return True
