"""Python threads that live in robot time.

A robot's threads stay real threads, but only one of them, or the thread that drives the clock, runs at a time: it
keeps the turn until it waits (sleeps, asks for a lock that is taken, joins another thread, ends), and the clock decides
who is next. So a run with threads is as repeatable as one without, and a thread that sleeps for a second costs
no second.

Nothing on the index does this: event-loop clocks (trio's, asyncio's) need code written for them, and robot
code is plain threads.

A thread that waits for the world outside (a socket, a serial port) cannot be waited for in robot time. When the thread
that has the turn is found to use no processor time, the clock takes the turn back and goes on; the thread rejoins with
the next thing it does in robot time. What such a thread does is as repeatable as the world it listens to.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import TracebackType

from ..compat.cpython_private import LockType, allocate_lock
from .clock import WAKE_UP, Clock
from .exceptions import TestEnded, TestFroze

# Bound before these names are patched for robot code: this module needs the real ones.
real_allocate_lock = allocate_lock
real_thread_join = threading.Thread.join
_process_time, _get_ident = time.process_time, threading.get_ident

#: How often a thread is told that the run is over, before it counts as one that will not stop.
_TELL_TO_STOP = 1000
# A thread that has the turn and lets this much wall time pass, in so many looks, on (nearly) no processor time, is
# blocked in the outside world. It decides only when to stop waiting for it, not how a test ends.
_LOOK_SECONDS, _LOOKS, _IDLE_CPU_SECONDS = 0.05, 8, 0.004


class RobotThread:
    """One thread of the robot, and whether it is its turn."""

    def __init__(self, thread: threading.Thread | None) -> None:
        self.thread = thread
        self.ident: int | None = None
        self.finished = False
        self.detached = False  # it waits in the outside world; the clock goes on without it
        self.is_the_robot = False  # its end is the robot program's
        self.error: BaseException | None = None
        self.joiners: list[RobotThread] = []
        self.waits = 0  # counts its waits, so that a wake-up that comes too late finds nobody
        self.go = _taken_lock()  # released when it is its turn
        self.done = _taken_lock()  # released when it hands the turn back

    @property
    def left_alone(self) -> bool:
        return self.detached and self.thread is not None and self.thread.daemon


def _taken_lock() -> LockType:
    lock = real_allocate_lock()
    lock.acquire()
    return lock


def _wants_to_run(record: RobotThread) -> bool:
    """Whether the thread only waits for a processor, where the system tells: then the machine is busy, no more."""
    native = record.thread.native_id if record.thread is not None else None
    try:
        state = Path(f"/proc/self/task/{native}/stat").read_text("ascii").rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state == "R"


def _below_threading(traceback: TracebackType | None) -> TracebackType | None:
    """The traceback from the thread's own function on."""
    inner = traceback
    while inner is not None and inner.tb_frame.f_code.co_filename in (__file__, threading.__file__):
        inner = inner.tb_next
    return inner or traceback


class RobotThreads:
    """All threads of one robot run. The thread that creates this drives the clock."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.driver = _get_ident()
        #: The thread whose turn it is; None while the driver itself runs.
        self.running: RobotThread | None = None
        self._threads: dict[int, RobotThread] = {}
        self._all: list[RobotThread] = []
        self.ending = False
        self._over = False
        #: What went wrong while robot code on the driver waited; for whoever runs the robot to raise.
        self.failure: BaseException | None = None
        #: Called when robot code on the driver's own thread is about to wait.
        self.before_driver_waits: list[Callable[[], object]] = []
        #: Called when the thread of a robot with a loop of its own is about to wait.
        self.before_loop_waits: Callable[[], object] | None = None
        #: How many waits of robot code the driver is in the middle of, one within the other.
        self.driver_waits = 0

    # -- what threads ask for ----------------------------------------------------------------------------------

    def current(self) -> RobotThread | None:
        """The robot thread that calls this, if it is one."""
        return self._threads.get(_get_ident())

    def takes_part(self) -> bool:
        """Whether the calling thread lives in robot time (the driver does, while it is in charge)."""
        ident = _get_ident()
        return (ident == self.driver and not self._over) or ident in self._threads

    def start(self, thread: threading.Thread | None = None) -> RobotThread:
        """Prepare a thread whose first turn comes as soon as time moves; its body goes through `run_body`."""
        record = RobotThread(thread)
        self._all.append(record)
        self._wake(record, self.clock.now_us)
        return record

    def run_body(self, record: RobotThread, body: Callable[[], object]) -> None:
        """What the new thread itself executes: wait for its turn, do its work, hand the turn back for good."""
        record.ident = _get_ident()
        self._threads[record.ident] = record
        record.go.acquire()
        try:
            if not self.ending:
                body()
        except TestEnded:
            pass
        except BaseException as error:
            if isinstance(error, SystemExit) and not record.is_the_robot:
                return  # as in any thread
            record.error = error.with_traceback(_below_threading(error.__traceback__))
        finally:
            self._threads.pop(record.ident, None)
            record.finished = True
            if record.detached:  # nobody waits for its turn to end
                self.clock.at(self.clock.now_us, WAKE_UP, partial(self._bury, record))
            record.done.release()

    def sleep_until(self, due_us: int) -> None:
        """Let the calling thread go on when robot time reaches `due_us`."""
        __tracebackhide__ = True
        me = self.current()
        if me is None:
            with self._robot_code_waits():
                self.clock.run_until(due_us)
        else:
            self._wake(me, due_us)
            self._park(me)

    def wait(self, waiters: list[RobotThread], ready: Callable[[], bool], timeout_us: int | None) -> bool:
        """Let the calling thread go on when `ready` answers True, or after `timeout_us`; answers which it was.

        Whoever makes `ready` true calls `notify` with the same `waiters`.
        """
        __tracebackhide__ = True
        clock = self.clock
        deadline = None if timeout_us is None else clock.now_us + timeout_us
        me = self.current()
        if me is None:
            if ready():
                return True
            answer = False

            def waiting() -> bool:
                nonlocal answer
                answer = answer or ready()
                return not answer and (deadline is None or clock.now_us < deadline)

            with self._robot_code_waits():
                clock.run_while(waiting, deadline)
            return answer or ready()
        while not ready():
            if deadline is not None:
                if clock.now_us >= deadline:
                    return False
                self._wake(me, deadline)
            waiters.append(me)
            try:
                self._park(me)
            finally:
                waiters.remove(me)
        return True

    def notify(self, waiters: list[RobotThread]) -> None:
        """Have each of the waiting threads look again, now."""
        for record in waiters:
            self._wake(record, self.clock.now_us)

    @contextlib.contextmanager
    def _robot_code_waits(self) -> Iterator[None]:
        """Robot code on the driver's own thread has asked for time to pass.

        A failure that comes up meanwhile elsewhere (the test's assertion, another thread's exception) is not for this
        code to catch: it is kept for whoever runs the robot, and this code is unwound.
        """
        __tracebackhide__ = True
        if self.ending or self.clock.halted:
            raise TestEnded
        for listener in self.before_driver_waits:
            listener()
        self.driver_waits += 1
        try:
            yield
        except Exception as failure:
            self.fail(failure)
            raise TestEnded from None
        finally:
            self.driver_waits -= 1

    def fail(self, failure: BaseException) -> None:
        """Keep what went wrong first, and let nobody wait any longer."""
        self.failure = self.failure or failure
        self.clock.halted = True

    # -- the turn -----------------------------------------------------------------------------------------------

    def _wake(self, record: RobotThread, due_us: int) -> None:
        waits = record.waits

        def wake_up() -> None:
            __tracebackhide__ = True
            if record.waits == waits and not record.finished:
                self._give_turn(record)

        self.clock.at(due_us, WAKE_UP, wake_up)

    def _park(self, me: RobotThread) -> None:
        """Hand the turn back and wait for the next one."""
        __tracebackhide__ = True
        if me.is_the_robot and self.before_loop_waits is not None:
            self.before_loop_waits()
        me.done.release()
        me.go.acquire()
        me.waits += 1
        if self.ending:
            raise TestEnded

    def _give_turn(self, record: RobotThread) -> None:
        """Let `record` run until it waits again. Called on the driver, from within the clock."""
        __tracebackhide__ = True
        if record.detached:
            # Only a thread that waits in robot time again is woken: it has just handed back its last turn.
            record.done.acquire()
            record.detached = False
        before, self.running = self.running, record
        record.go.release()
        self._await_turn_back(record)
        self.running = before
        if record.finished:
            self._bury(record)

    def _await_turn_back(self, record: RobotThread) -> None:
        __tracebackhide__ = True
        if record.done.acquire(timeout=_LOOK_SECONDS):
            return
        looks, cpu = 0, _process_time()
        while not record.done.acquire(timeout=_LOOK_SECONDS):
            looks += 1
            if looks == _LOOKS:
                if _process_time() - cpu < _IDLE_CPU_SECONDS and not _wants_to_run(record):
                    record.detached = True
                    return
                looks, cpu = 0, _process_time()

    def _bury(self, record: RobotThread) -> None:
        __tracebackhide__ = True
        self._all.remove(record)
        if record.thread is not None:
            real_thread_join(record.thread)  # it only has its last few instructions left; is_alive() must not waver
        self.notify(record.joiners)
        if record.error is not None:
            raise record.error

    # -- the end ------------------------------------------------------------------------------------------------

    def end(self) -> list[RobotThread]:
        """Raise `TestEnded` in whatever each thread waits for; answers the threads that did not stop.

        A daemon thread that waits for the world outside does no harm where it is, and is not one of them.
        """
        self.ending = True
        hangs: TestFroze | None = None
        for record in list(self._all):
            if record.detached and record.done.acquire(blocking=False):
                record.detached = False
                record.done.release()
            for _ in range(_TELL_TO_STOP):
                if record.finished or record.detached:
                    break
                try:
                    self._give_turn(record)
                except TestFroze as froze:
                    hangs = froze
                except Exception:
                    break  # what a thread says while it is being stopped
        self._over = True
        if hangs is not None:
            raise hangs
        return [record for record in self._all if not (record.finished or record.left_alone)]
