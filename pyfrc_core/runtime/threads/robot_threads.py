"""Python threads in robot time.

A robot's threads are real threads, but only one of them, or the thread that drives the clock, runs at a time. A thread
keeps its turn until it waits (sleeps, acquires a lock that is taken, joins another thread, ends), and the clock chooses
the next one. So a run with threads is as repeatable as one without, and a sleep of one second takes no second.

No package on the index does this: the clocks of event loops (trio, asyncio) need code that is written for them, and
robot code uses plain threads.

A thread that waits for something outside the process (a socket, a serial port) cannot wait in robot time. If the thread
that has the turn uses no processor time, the clock takes the turn back and continues; the thread rejoins at its next
wait in robot time. Such a thread is only as repeatable as what it waits for.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import TracebackType

from ...compat.cpython_private import LockType, allocate_lock, target_of
from ..clock import WAKE_UP, Clock
from ..exceptions import TestEnded, TestFroze
from .thread_cpu import ThreadTimes

# Bound before these names are patched for robot code: this module needs the real ones.
real_allocate_lock = allocate_lock
real_thread_join = threading.Thread.join
_process_time, _get_ident = time.process_time, threading.get_ident

_AFTER_ALL_TIMEOUTS = 1e9
#: How often `TestEnded` is raised in a thread before it counts as one that does not stop.
_TELL_TO_STOP = 1000
# A thread that has the turn and uses (nearly) no processor time for this much wall time, in this many looks, waits for
# something outside the process. This decides only when to stop waiting for it, not the result of a test. While other
# threads of the process are busy, it may wait for one of them that computes for it, and gets more looks.
_LOOK_SECONDS, _LOOKS, _LOOKS_BESIDE_OTHERS, _IDLE_CPU_SECONDS = 0.05, 8, 24, 0.004


class RobotThread:
    """One thread of the robot, and whether it has the turn."""

    def __init__(self, thread: threading.Thread | None) -> None:
        self.thread = thread
        self.ident: int | None = None
        #: Its processor time, when it has begun.
        self.times: ThreadTimes | None = None
        self.finished = False
        self.detached = False  # it waits for something outside the process; the clock continues without it
        self.is_the_robot = False  # its end is the robot program's
        self.error: BaseException | None = None
        self.ready: Callable[[], bool] | None = None  # whether what it waits for is there
        self.left_at: str | None = None  # the user's line where it waited when the robot had ended
        self.joiners: list[RobotThread] = []
        self.waits = 0  # counts its waits, so that a late wake-up has no effect
        self.go = _taken_lock()  # released when it is its turn
        self.done = _taken_lock()  # released when it hands the turn back

    def cpu(self) -> float:
        """Return its processor time, in seconds; that of the process until it has begun."""
        return _process_time() if self.times is None else self.times.cpu()

    @property
    def left_alone(self) -> bool:
        return self.detached and self.thread is not None and self.thread.daemon


def _wants_to_run(record: RobotThread) -> bool:
    """Whether the thread only waits for a processor of a busy machine. False where the system does not say."""
    native = record.thread.native_id if record.thread is not None else None
    try:
        state = Path(f"/proc/self/task/{native}/stat").read_text("ascii").rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state == "R"


def _taken_lock() -> LockType:
    lock = real_allocate_lock()
    lock.acquire()
    return lock


def _below_threading(traceback: TracebackType | None) -> TracebackType | None:
    """Return the traceback from the thread's own function on."""
    inner = traceback
    while inner is not None and inner.tb_frame.f_code.co_filename in (__file__, threading.__file__):
        inner = inner.tb_next
    return inner or traceback


class RobotThreads:
    """The threads of one robot run. The thread that creates this object drives the clock."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.driver = _get_ident()
        self._drivers_times = ThreadTimes()
        #: The thread whose turn it is; None while the driver itself runs.
        self.running: RobotThread | None = None
        self._threads: dict[int, RobotThread] = {}
        self._all: list[RobotThread] = []
        #: Set while threads see the end of the robot program, and waits with a time-out end early.
        self.closing = False
        self.ending = False
        self._over = False
        #: The failure that occurred while robot code on the driver waited. The code that runs the robot raises it.
        self.failure: BaseException | None = None
        #: Called when robot code on the driver's own thread is about to wait.
        self.before_driver_waits: list[Callable[[], object]] = []
        #: Called when the thread of a robot with a loop of its own is about to wait.
        self.before_loop_waits: Callable[[], object] | None = None
        #: The number of nested waits of robot code on the driver.
        self.driver_waits = 0

    # -- what threads ask for ----------------------------------------------------------------------------------

    def current(self) -> RobotThread | None:
        """Return the calling thread's record, or None if it is no robot thread."""
        return self._threads.get(_get_ident())

    def takes_part(self) -> bool:
        """Whether the calling thread is in robot time. The driver is, until the run is over."""
        ident = _get_ident()
        return (ident == self.driver and not self._over) or ident in self._threads

    def start(self, thread: threading.Thread | None = None) -> RobotThread:
        """Register a thread whose first turn comes as soon as time moves. It has to call `run_body`."""
        record = RobotThread(thread)
        self._all.append(record)
        self._wake(record, self.clock.now_us)
        return record

    def run_body(self, record: RobotThread, body: Callable[[], object]) -> None:
        """Wait for the first turn, call `body`, and hand the turn back for good. Called by the new thread."""
        record.ident, record.times = _get_ident(), ThreadTimes()
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
            if record.detached:  # the driver does not wait for the end of its turn
                self.clock.at(self.clock.now_us, WAKE_UP, partial(self._bury, record))
            record.done.release()

    def sleep_until(self, due_us: int) -> None:
        """Block the calling thread until robot time reaches `due_us`."""
        __tracebackhide__ = True
        me = self.current()
        if me is None:
            with self._robot_code_waits():
                self.clock.run_until(due_us)
        else:
            self._wake(me, due_us)
            self._park(me)

    def wait(self, waiters: list[RobotThread], ready: Callable[[], bool], timeout_us: int | None) -> bool:
        """Block the calling thread until `ready` returns True, or for `timeout_us`. Return whether it is ready.

        Code that makes `ready` true calls `notify` with the same `waiters`.
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
            me.ready = ready
            try:
                self._park(me)
            finally:
                me.ready = None
                waiters.remove(me)
            if self.closing and deadline is not None:
                return ready()
        return True

    def time_of_waits(self) -> float:
        """Return the robot time, in seconds, by which waits of the standard library compute what is left of them."""
        return self.clock.now + (_AFTER_ALL_TIMEOUTS if self.closing else 0.0)

    def notify(self, waiters: list[RobotThread]) -> None:
        """Make each waiting thread check again, at the current time."""
        for record in waiters:
            self._wake(record, self.clock.now_us)

    @contextlib.contextmanager
    def _robot_code_waits(self) -> Iterator[None]:
        """Surround a wait of robot code on the driver's thread.

        A failure that occurs elsewhere meanwhile (the test's assertion, another thread's exception) must not be caught
        by this robot code: it is stored for the code that runs the robot, and this code is unwound.
        """
        __tracebackhide__ = True
        if self.ending or self.clock.halted:
            raise TestEnded
        for listener in self.before_driver_waits:
            listener()
        self.driver_waits += 1
        try:
            yield
        except (Exception, TestFroze) as failure:
            self.fail(failure)
            raise TestEnded from None
        finally:
            self.driver_waits -= 1

    def fail(self, failure: BaseException) -> None:
        """Store the first failure, and let no code wait any longer."""
        self.failure = self.failure or failure
        self.clock.halted = True

    # -- the turn -----------------------------------------------------------------------------------------------

    def whose_turn(self) -> tuple[int, ThreadTimes]:
        """Return the thread that has the turn, by its `ident`, and its times. Any thread may ask."""
        running = self.running
        if running is None or running.ident is None or running.times is None:  # it has not begun
            return self.driver, self._drivers_times
        return running.ident, running.times

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
        """Let `record` run until it waits again. The clock calls this on the driver."""
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
        looks, of_all, own = 0, _process_time(), record.cpu()
        while not record.done.acquire(timeout=_LOOK_SECONDS):
            looks += 1
            if looks % _LOOKS:
                continue
            if abs(record.cpu() - own) >= _IDLE_CPU_SECONDS or _wants_to_run(record):  # less: it has begun just now
                looks, of_all, own = 0, _process_time(), record.cpu()
            elif _process_time() - of_all < looks // _LOOKS * _IDLE_CPU_SECONDS or looks >= _LOOKS_BESIDE_OTHERS:
                record.detached = True
                return

    def _bury(self, record: RobotThread) -> None:
        __tracebackhide__ = True
        if record not in self._all:  # it has ended just as it was detached
            return
        self._all.remove(record)
        if record.thread is not None:
            real_thread_join(record.thread)  # it is about to end: is_alive() must be the same in every run
        self.notify(record.joiners)
        if record.error is not None:
            raise record.error

    # -- the end ------------------------------------------------------------------------------------------------

    def end(self, line_of: Callable[[int | None], str | None] = lambda ident: None) -> list[RobotThread]:
        """Raise `TestEnded` in each thread's wait. Return the threads that did not stop.

        A daemon thread that waits for something outside the process does no harm, and is not among them. A thread that
        is no daemon would keep the robot program from ending: its wait ends early, once, and it has to end then.

        :param line_of: returns the user's line that a thread is at
        """
        hangs: TestFroze | None = None
        left_running = []
        self.closing = True
        for record in [each for each in self._all if self._must_end(each)]:
            record.left_at = line_of(record.ident)
            try:
                self._give_turn(record)
            except TestFroze as froze:
                hangs = froze
            except Exception:
                continue  # as below
            if not (record.finished or record.is_the_robot):
                left_running.append(record)
        self.ending = True
        for record in list(self._all):
            if record.detached and record.done.acquire(blocking=False):
                record.detached = False
            for _ in range(_TELL_TO_STOP):
                if record.finished or record.detached:
                    break
                try:
                    self._give_turn(record)
                except TestFroze as froze:
                    hangs = froze
                except Exception:
                    break  # an error of a thread that is being stopped
        self._over = True
        if hangs is not None:
            raise hangs
        stuck = [record for record in self._all if not (record.finished or record.left_alone)]
        return [*left_running, *(record for record in stuck if record not in left_running)]

    @property
    def must_end(self) -> bool:
        """Whether there are threads, besides the robot's own, for which Python would wait at the end of the program."""
        return any(self._must_end(record) and not record.is_the_robot for record in self._all)

    def _must_end(self, record: RobotThread) -> bool:
        """Return whether Python would wait for this thread at the end of the robot program.

        A loop of the robot's own ends if `endCompetition` has ended what it waits for; it may have files to close.
        """
        thread = record.thread
        if record.is_the_robot:
            return record.ready is not None and record.ready()
        if thread is None or thread.daemon or record.finished or record.detached or self.failure is not None:
            return False
        return "concurrent.futures" not in getattr(target_of(thread), "__module__", "")  # Python ends those itself
