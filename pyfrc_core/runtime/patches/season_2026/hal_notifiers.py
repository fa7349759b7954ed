"""WPILib's notifiers in robot time: the HAL's own, as Python code calls them, and `wpilib.Notifier`."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

import hal
import wpilib
import wpiutil.sync

from ....patch_table import Patch
from ...clock import to_us
from ...threads.robot_threads import RobotThread, RobotThreads
from .. import event_waits
from ..active_run import active_run
from ..notifier import PeriodicThread

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


class Notifier(PeriodicThread):
    """Calls a function once after a delay, or periodically, on a thread of its own: `wpilib.Notifier` in robot time.

    :param handler: called at the notification time
    """

    def setName(self, name: str) -> None:
        """Name the notifier, for debugging."""
        self._rename(name)

    def setCallback(self, handler: Callable[[], object]) -> None:
        """Call another function from now on."""
        self.use_handler(handler)

    def startSingle(self, delay: float) -> None:
        """Call the handler once, `delay` seconds from now."""
        self._start(delay, None)

    def startPeriodic(self, period: float) -> None:
        """Call the handler every `period` seconds, first one period from now."""
        self._start(period, to_us(period))

    def stop(self) -> None:
        """Stop the calls until it is started again. A call in progress is not interrupted."""
        self._stop()

    @staticmethod
    def setHALThreadPriority(realTime: bool, priority: int) -> bool:
        """Return True, as WPILib's simulation does: simulated threads have no priorities."""
        return True


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""

    def notifier_call(name: str, ours: str) -> Patch:
        real = getattr(hal, name)

        def call(*args: object, **kwargs: object) -> Any:
            __tracebackhide__ = True
            run = active_run.run
            handle = args[0] if args else kwargs.get("notifierHandle")
            if run is not None and (handle is None or handle in run.alarms):
                return getattr(run.alarms, ours)(*args, **kwargs)
            return real(*args, **kwargs)

        return Patch(hal, name, call)

    real_set_name = hal.setNotifierName

    def set_notifier_name(notifierHandle: int, name: str) -> Any:
        ours = active_run.run is not None and notifierHandle in active_run.run.alarms
        return 0 if ours else real_set_name(notifierHandle, name)

    return [
        Patch(wpilib, "Notifier", Notifier),
        notifier_call("initializeNotifier", "initialize"),
        notifier_call("updateNotifierAlarm", "update"),
        notifier_call("cancelNotifierAlarm", "cancel"),
        notifier_call("waitForNotifierAlarm", "wait"),
        notifier_call("stopNotifier", "stop"),
        notifier_call("cleanNotifier", "clean"),
        Patch(hal, "setNotifierName", set_notifier_name),
        Patch(wpiutil.sync, "waitForObject", event_waits.in_robot_time(wpiutil.sync.waitForObject)),
    ]
