"""The loop of a `wpilib.TimedRobot`, in place: its loop body and periodic callbacks, called as they fall due.

WPILib's own loop blocks in C++ until the next alarm, so it would need a thread of its own, and two hand-offs between
threads for each loop. Here the clock calls the body on whichever thread moves the time. A robot that overrides
`startCompetition` and calls `super().startCompetition()` gets `run_blocking` instead.
"""

from __future__ import annotations

from collections.abc import Callable
from heapq import heapify, heappop, heappush

from ...wpi import robots
from ..clock import PACKET_US, ROBOT_LOOP, Clock, to_us
from ..threads.robot_threads import RobotThreads

_NEVER = 1 << 62


class Periodic:
    """One callback with its own rate.

    :param order: which of several that are due at once comes first
    """

    __slots__ = ("call", "due_us", "order", "period_us")

    def __init__(self, call: Callable[[], object], first_due_us: int, period_us: int, order: int) -> None:
        self.call = call
        self.due_us = first_due_us
        self.period_us = period_us
        self.order = order

    def __lt__(self, other: Periodic) -> bool:
        return (self.due_us, self.order) < (other.due_us, other.order)

    def move_on(self, called_at_us: int) -> None:
        """Fix the next time, skipping the periods that were missed, as WPILib does."""
        self.due_us += self.period_us + (called_at_us - self.due_us) // self.period_us * self.period_us


class TimedLoop:
    """The callbacks of one `TimedRobot`.

    They are in a heap, as in WPILib. Which of several that are due at once comes first, depends in 2026 on what was
    taken from it and put into it before: Python's heaps break ties as the C++ library of the robot does. In 2027 they
    keep the order in which they were added, the robot's own turn first.

    :param created_us: when the robot was constructed; its periods count from there
    :param on_initialized: called when the robot's own initialisation is over
    :param when_overrun: called with the microseconds that a callback took, when these are more than its period
    """

    def __init__(
        self,
        clock: Clock,
        created_us: int,
        on_initialized: Callable[[], None],
        when_overrun: Callable[[int], object],
    ) -> None:
        self._clock = clock
        self._when_overrun = when_overrun
        self._on_initialized = on_initialized
        self._created_us = created_us
        self._callbacks: list[Periodic] = []
        self._added = 0
        self._turn_of_robot: Periodic | None = None
        #: Whether the clock calls what is due: from the end of `robotInit` on.
        self.in_place = False
        self._turns_on_own_thread = False
        self._alarm_us = _NEVER
        self.stopped = False
        #: Called after each callback, which began at `loop_start_us`.
        self.after_calls: list[Callable[[Periodic], None]] = []
        #: Called before these, after each callback in which robot time has passed.
        self.after_waits: list[Callable[[Periodic], None]] = []
        #: The callback that is WPILib's loop; None until `robotInit` is over.
        self.main: Periodic | None = None
        #: When the current turn of the loop began: `TimedRobot.getLoopStartTime`, in microseconds.
        self.loop_start_us = 0

    def add(self, robot: robots.Timed, call: Callable[[], object], period: float, offset: float = 0.0) -> None:
        """`TimedRobot.addPeriodic`: times in seconds."""
        if not callable(call):
            raise TypeError(f"addPeriodic: the callback is {call!r}, not a function: write it without parentheses")
        period_us = to_us(period)
        if period_us <= 0:
            raise ValueError(f"addPeriodic: the period must be longer than 0 s, not {period!r}")
        self._schedule_turns(robot)
        periods_gone = (self._clock.now_us - self._created_us) // period_us
        first = self._created_us + to_us(offset) + (periods_gone + 1) * period_us
        callback = self.schedule(call, first, period_us)
        if self.in_place and callback.due_us < self._alarm_us < _NEVER:
            self._set_alarm(callback)

    def _schedule_turns(self, robot: robots.Timed) -> Periodic:
        """Put WPILib's loop into the schedule, as the robot's constructor does: before all others."""
        if self._turn_of_robot is None:
            period_us = to_us(robots.period(robot, PACKET_US / 1_000_000))
            self._turn_of_robot = self.schedule(robots.turn_of(robot), self._created_us + period_us, period_us)
        return self._turn_of_robot

    def next_order(self) -> int:
        """Return the order of the callback that is added next, among those that are due at once."""
        self._added += robots.CALLBACKS_KEEP_THEIR_ORDER
        return self._added

    def schedule(
        self, call: Callable[[], object], first_due_us: int, period_us: int, order: int | None = None
    ) -> Periodic:
        """Put a callback, or WPILib's loop, into the schedule.

        :param order: from `next_order`, for a callback that comes before others that were added earlier
        """
        callback = Periodic(call, first_due_us, period_us, self.next_order() if order is None else order)
        heappush(self._callbacks, callback)
        return callback

    def remove(self, callback: Periodic) -> None:
        """Take a callback out of the schedule. It must not be the one that is being called."""
        self._callbacks.remove(callback)
        heapify(self._callbacks)

    def begin(self, robot: robots.Timed) -> None:
        """What WPILib does before its first loop: the robot's own initialisation, then the loop's schedule."""
        __tracebackhide__ = True
        robots.initialize(robot)
        self._on_initialized()
        robots.report_start()
        self.main = self._schedule_turns(robot)

    def run_in_place(self) -> None:
        """Let the clock call what is due from now on."""
        self.in_place = True
        self._set_alarm(self._callbacks[0])

    @property
    def in_turn(self) -> bool:
        """Whether a turn of the loop is going on."""
        return self._alarm_us == _NEVER if self.in_place else self._turns_on_own_thread

    def _set_alarm(self, callback: Periodic) -> None:
        """Begin the next turn when this callback is due, instead of at the time that was set before."""
        self._alarm_us = callback.due_us
        self._clock.at(callback.due_us, ROBOT_LOOP, self._on_alarm)

    def _on_alarm(self) -> None:
        __tracebackhide__ = True
        clock = self._clock
        if self._alarm_us <= clock.now_us and not self.stopped:
            self._alarm_us = _NEVER  # no other turn begins within this one, however long it takes
            self._alarm_us = due_us = self._turn().due_us
            clock.at(due_us, ROBOT_LOOP, self._on_alarm)  # as `_set_alarm`

    def run_blocking(self, threads: RobotThreads) -> None:
        """Call what is due on the calling thread, which waits in between, until the run ends."""
        __tracebackhide__ = True
        callback = self._callbacks[0]
        while not self.stopped:
            threads.wait([], lambda: self.stopped, callback.due_us - self._clock.now_us)
            if self.stopped:
                break
            self._turns_on_own_thread = True
            callback = self._turn()
            self._turns_on_own_thread = False

    def _turn(self) -> Periodic:
        """Call the callbacks that are due, one after the other, however long each takes. Return the next one."""
        __tracebackhide__ = True
        clock, callbacks = self._clock, self._callbacks
        woken_us = clock.now_us
        while callbacks[0].due_us <= woken_us and not self.stopped:
            callback = heappop(callbacks)
            self.loop_start_us = clock.now_us
            callback.call()
            if clock.now_us != self.loop_start_us:
                self._on_wait(callback)
            for listener in self.after_calls:
                listener(callback)
            callback.move_on(woken_us)
            heappush(callbacks, callback)
        return callbacks[0]

    def _on_wait(self, callback: Periodic) -> None:
        took_us = self._clock.now_us - self.loop_start_us
        if took_us > callback.period_us:
            self._when_overrun(took_us)
        for listener in self.after_waits:
            listener(callback)
