"""WPILib's notifiers in robot time: what a season's `Notifier` and its HAL's alarms are made of.

WPILib's real notifiers are C++ threads; two that come due together would race for Python's lock, and the run would not
be repeatable. These are robot threads like any other (see `threads`).
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from ..clock import to_us
from ..threads.cooperative import start_in_robot_time
from ..threads.robot_threads import RobotThread, RobotThreads


class _Schedule:
    """The state of a notifier's thread. Not the `Notifier` itself: as in WPILib, deleting that stops the thread."""

    def __init__(self, handler: Callable[[], object]) -> None:
        self.handler = handler
        self.period_us: int | None = None
        self.due_us: int | None = None
        self.ended = False
        self.waiters: list[RobotThread] = []


class PeriodicThread:
    """Calls a function once after a delay, or periodically, on a thread of its own, in robot time.

    :param handler: called at the notification time
    """

    #: The threads of the active run; set by `active_run` while there is one.
    threads: RobotThreads | None = None

    def __init__(self, handler: Callable[[], object]) -> None:
        if not callable(handler):
            raise TypeError(f"Notifier(handler): handler must be callable, not {type(handler).__name__}")
        self._schedule = _Schedule(handler)
        self._name = "Notifier"
        self._thread: threading.Thread | None = None

    def _rename(self, name: str) -> None:
        self._name = name
        if self._thread is not None:
            self._thread.name = name

    def use_handler(self, handler: Callable[[], object]) -> None:
        """Call another function from now on."""
        self._schedule.handler = handler

    def _stop(self) -> None:
        self._schedule.due_us = None
        self._schedule.period_us = None

    def __del__(self) -> None:
        schedule = getattr(self, "_schedule", None)
        if schedule is not None:
            schedule.ended = True
            if PeriodicThread.threads is not None:
                PeriodicThread.threads.notify(schedule.waiters)

    def _start(self, delay: float, period_us: int | None) -> None:
        schedule, threads = self._schedule, PeriodicThread.threads
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
        threads = PeriodicThread.threads
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
