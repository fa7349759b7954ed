"""WPILib's notifiers in robot time: the HAL's own, as Python code calls them, and `wpilib.Notifier` on top.

WPILib's real notifiers are C++ threads; two that come due together would race for Python's lock, and the run would not
be repeatable. These are robot threads like any other (see `threads`).
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from itertools import count

from ..clock import to_us
from ..threads.cooperative import start_in_robot_time
from ..threads.robot_threads import RobotThread, RobotThreads

# Real HAL handles are small numbers, so ours differ from those made before the run.
_FIRST_HANDLE = 0x5059_0000


class Alarm:
    """One HAL notifier: the time it is set to, and the threads that wait for it."""

    def __init__(self) -> None:
        self.due_us: int | None = None
        self.stopped = False
        self.waiters: list[RobotThread] = []


class Alarms:
    """`hal.initializeNotifier` and its kin, in the time of one robot run. Status codes are always 0, success."""

    def __init__(self, threads: RobotThreads) -> None:
        self._threads = threads
        self._handles = count(_FIRST_HANDLE)
        self._alarms: dict[int, Alarm] = {}

    def __contains__(self, handle: object) -> bool:
        return handle in self._alarms

    def initialize(self) -> tuple[int, int]:
        handle = next(self._handles)
        self._alarms[handle] = Alarm()
        return handle, 0

    # The parameters have the HAL's names, by which they can be given.

    def update(self, notifierHandle: int, triggerTime: int) -> int:
        return self._set(notifierHandle, int(triggerTime))

    def cancel(self, notifierHandle: int) -> int:
        return self._set(notifierHandle, None)

    def stop(self, notifierHandle: int) -> int:
        self._alarms[notifierHandle].stopped = True
        self._threads.notify(self._alarms[notifierHandle].waiters)
        return 0

    def clean(self, notifierHandle: int) -> None:
        self.stop(notifierHandle)
        del self._alarms[notifierHandle]

    def wait(self, notifierHandle: int) -> tuple[int, int]:
        """Return the time at which the alarm went off, in microseconds, or 0 when it was stopped."""
        __tracebackhide__ = True
        alarm, clock = self._alarms[notifierHandle], self._threads.clock
        while not alarm.stopped:
            if alarm.due_us is not None and alarm.due_us <= clock.now_us:
                alarm.due_us = None
                return clock.now_us, 0
            due = alarm.due_us
            timeout = None if due is None else due - clock.now_us
            # Woken early when the alarm is set again; then this checks again.
            self._threads.wait(alarm.waiters, lambda: alarm.stopped or alarm.due_us != due, timeout)  # noqa: B023
        return 0, 0

    def _set(self, handle: int, due_us: int | None) -> int:
        self._alarms[handle].due_us = due_us
        self._threads.notify(self._alarms[handle].waiters)
        return 0


class _Schedule:
    """The state of a notifier's thread. Not the `Notifier` itself: as in WPILib, deleting that stops the thread."""

    def __init__(self, handler: Callable[[], object]) -> None:
        self.handler = handler
        self.period_us: int | None = None
        self.due_us: int | None = None
        self.ended = False
        self.waiters: list[RobotThread] = []


class Notifier:
    """Calls a function once after a delay, or periodically, on a thread of its own: `wpilib.Notifier` in robot time.

    :param handler: called at the notification time
    """

    #: The threads of the active run; set by `patches` while there is one.
    threads: RobotThreads | None = None

    def __init__(self, handler: Callable[[], object]) -> None:
        if not callable(handler):
            raise TypeError(f"Notifier(handler): handler must be callable, not {type(handler).__name__}")
        self._schedule = _Schedule(handler)
        self._name = "Notifier"
        self._thread: threading.Thread | None = None

    def setName(self, name: str) -> None:
        """Name the notifier, for debugging."""
        self._name = name
        if self._thread is not None:
            self._thread.name = name

    def setCallback(self, handler: Callable[[], object]) -> None:
        """Call another function from now on."""
        self._schedule.handler = handler

    def startSingle(self, delay: float) -> None:
        """Call the handler once, `delay` seconds from now."""
        self._start(delay, None)

    def startPeriodic(self, period: float) -> None:
        """Call the handler every `period` seconds, first one period from now."""
        self._start(period, to_us(period))

    def stop(self) -> None:
        """Stop the calls until it is started again. A call in progress is not interrupted."""
        self._schedule.due_us = None
        self._schedule.period_us = None

    @staticmethod
    def setHALThreadPriority(realTime: bool, priority: int) -> bool:
        """Return True, as WPILib's simulation does: simulated threads have no priorities."""
        return True

    def __del__(self) -> None:
        schedule = getattr(self, "_schedule", None)
        if schedule is not None:
            schedule.ended = True
            if Notifier.threads is not None:
                Notifier.threads.notify(schedule.waiters)

    def _start(self, delay: float, period_us: int | None) -> None:
        schedule, threads = self._schedule, Notifier.threads
        now = 0 if threads is None else threads.clock.now_us
        schedule.period_us = period_us
        schedule.due_us = now + to_us(delay)
        if self._thread is None:
            self._thread = threading.Thread(target=_serve, args=(schedule,), name=self._name, daemon=True)
            start_in_robot_time(self._thread)
        elif threads is not None:
            threads.notify(schedule.waiters)


def _serve(schedule: _Schedule) -> None:
    """Run the notifier's thread."""
    while not schedule.ended:
        threads = Notifier.threads
        if threads is None:
            return
        due, now = schedule.due_us, threads.clock.now_us
        if due is None or due > now:
            timeout = None if due is None else due - now
            threads.wait(schedule.waiters, lambda: schedule.ended or schedule.due_us != due, timeout)  # noqa: B023
            continue
        # The next time is fixed before the call, as in WPILib: a slow handler does not shift the ones after it.
        schedule.due_us = None if schedule.period_us is None else due + schedule.period_us
        schedule.handler()
