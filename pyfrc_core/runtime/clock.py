"""Robot time: a number that moves only when code moves it, and a queue of actions that are due at certain times.

The trade-off: nothing here waits. The caller of `run_until` says how far time moves, and all actions that are due
until then are called on the caller's thread, in one order. A robot that sleeps for half a second in its
`teleopPeriodic` moves the clock by half a second itself; driver-station packets, notifiers and other threads run
inside that call. So a run is fast (no hand-off between threads) and repeatable.

Times are whole microseconds, as in WPILib's HAL, so that 20 ms packets never drift.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, MutableSequence
from heapq import heappop, heappush

from ..season import CURRENT
from ..wpi import station, timing
from .exceptions import TestEnded, TestRanTooLong
from .robot_time import PACKET_US as PACKET_US
from .robot_time import to_us as to_us

DEFAULT_TIME_LIMIT = 500.0
#: A time limit that no run reaches.
NO_LIMIT_US = 1 << 62

#: The time of day in robot code at robot time 0, in seconds since 1970: the season's kickoff.
KICKOFF = int(CURRENT.kickoff.timestamp())

# Actions that are due at the same microsecond are called in this order: scripts write inputs, the driver station's
# packet is delivered, threads and notifiers wake up, the robot's loop runs, rules are checked, physics runs, what a log
# measured replaces what physics has written, observers look at the result.
INPUT, PACKET, WAKE_UP, ROBOT_LOOP, CHECK, PHYSICS, MEASURED, OBSERVE = range(8)

Action = Callable[[], None]

_step_us = timing.step_us


class Clock:
    """The robot time of one run, and the actions that are due in it.

    :param start_us: the time at which it starts, in microseconds: a robot program that is started again goes on there
    """

    def __init__(self, start_us: int = 0) -> None:
        #: Called before each packet with the robot time in seconds: the place to change inputs.
        self.before_packet: list[Callable[[float], None]] = []
        #: Delivers a packet. A run delivers it over its connection, which may be lost.
        self.deliver_packet: Action = station.deliver_packet
        self._recurring: list[tuple[int, int, Action]] = []
        #: Stands for the innermost call of `run_until` or `run_while` that has not returned; None between two calls.
        self.call: object = None
        #: The first number is the time in microseconds. It may be memory that another process reads.
        self.moment: MutableSequence[int] | memoryview = array("q", [0])
        self.initialize(start_us)

    def initialize(self, start_us: int = 0) -> None:
        """Stop HAL time, and clear the queue, except for packets (every 20 ms) and the actions of `every`.

        :param start_us: the time at which the clock starts, in microseconds
        """
        timing.stop_and_zero()
        self.now_us = 0
        self._move_to(start_us)
        self.limit_us = to_us(DEFAULT_TIME_LIMIT)
        self._queue: list[tuple[int, int, int, Action]] = []
        self._order = 0
        #: Set when the run is over or has failed. No code can wait any longer then, even if it catches `TestEnded`.
        self.halted = False
        self._next_packet = start_us + PACKET_US
        self.at(self._next_packet, PACKET, self._packet)
        for recurring in self._recurring:
            self._begin(*recurring)

    @property
    def now(self) -> float:
        """Robot time in seconds."""
        return self.now_us / 1_000_000

    def at(self, due_us: int, rank: int, action: Action) -> None:
        """Call `action` when robot time reaches `due_us`, or as soon as time moves if that has passed."""
        # The running number makes ties come first in, first out, and keeps the heap from comparing actions.
        self._order += 1
        heappush(self._queue, (due_us, rank, self._order, action))

    def every(self, period_us: int, rank: int, action: Action) -> None:
        """Call `action` every period from now on, first when one period has passed."""
        self._recurring.append((period_us, rank, action))
        self._begin(period_us, rank, action)

    def _begin(self, period_us: int, rank: int, action: Action) -> None:
        due = self.now_us + period_us

        def again() -> None:
            nonlocal due
            due += period_us
            self._order += 1
            heappush(self._queue, (due, rank, self._order, again))  # as `at`
            action()

        self.at(due, rank, again)

    def forget(self) -> None:
        """Clear the queue, recurring actions included, so that it holds no reference to the robot."""
        self._recurring.clear()
        self.initialize()

    def run_until(self, target_us: int) -> None:
        """Move time to `target_us`, and call the actions that are due until then, in order.

        An action may call this. Time never goes back: an inner call may move the clock beyond the target of the outer
        one.

        :raises TestRanTooLong: when the time limit comes first
        :raises TestEnded: when the run was halted
        """
        __tracebackhide__ = True
        if self.halted:
            raise TestEnded
        queue = self._queue
        end = min(target_us, self.limit_us)
        outer, self.call = self.call, object()
        try:
            while queue[0][0] <= end:  # there always is a next packet
                # As `_run_next` and `_move_to`, written out: everything in a run is called from here.
                due_us, _, _, action = heappop(self._queue)
                if due_us > self.now_us:
                    _step_us(due_us - self.now_us)
                    self.now_us = self.moment[0] = due_us
                action()
                if self.halted:
                    raise TestEnded
        finally:
            self.call = outer
        self._move_to(end)
        if target_us > self.limit_us:
            limit = self.limit_us / 1_000_000
            raise TestRanTooLong(
                f"the robot ran for more than {limit:g} s of robot time, the limit: does the test never end its run?"
            )

    def run_while(self, waiting: Callable[[], bool], deadline_us: int | None = None) -> None:
        """Call the actions that are due, one at a time, until `waiting` returns False or the deadline is reached.

        :raises TestRanTooLong: when the time limit comes first
        """
        __tracebackhide__ = True
        if self.halted:
            raise TestEnded
        queue = self._queue
        outer, self.call = self.call, object()
        try:
            while waiting():
                next_due = queue[0][0]
                if deadline_us is not None and next_due > deadline_us:
                    return self.run_until(deadline_us)
                if next_due > self.limit_us:
                    return self.run_until(next_due)
                self._run_next()
                if self.halted:
                    raise TestEnded
        finally:
            self.call = outer
        return None

    def _run_next(self) -> None:
        __tracebackhide__ = True
        due_us, _, _, action = heappop(self._queue)
        if due_us > self.now_us:  # most of what is due falls together with a packet
            self._move_to(due_us)
        action()

    def _move_to(self, time_us: int) -> None:
        if time_us > self.now_us:
            _step_us(time_us - self.now_us)
            self.now_us = self.moment[0] = time_us

    @property
    def next_packet_us(self) -> int:
        return self._next_packet

    def _packet(self) -> None:
        __tracebackhide__ = True
        self._next_packet = due_us = self._next_packet + PACKET_US
        self._order += 1
        heappush(self._queue, (due_us, PACKET, self._order, self._packet))  # as `at`
        for listener in self.before_packet:
            listener(self.now_us / 1_000_000)
        self.deliver_packet()
