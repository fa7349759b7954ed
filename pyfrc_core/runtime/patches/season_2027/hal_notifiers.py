"""WPILib's notifiers in robot time: the HAL's own, as Python code calls them, and `wpilib.Notifier`.

A handle of the HAL's is itself what `wpiutil.sync.wait_for_object` waits for, so it is replaced, too.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

import hal
import wpilib
import wpiutil.sync

from ....patch_table import Patch
from ....wpi.season_2027 import timing
from ...clock import to_us
from ...threads.robot_threads import RobotThread, RobotThreads
from .. import event_waits
from ..active_run import active_run
from ..notifier import PeriodicThread

# Real HAL handles are of another type: see `watchdogs`.
_FIRST_HANDLE = 0x5059_0000


class Alarm:
    """One HAL notifier: the time it is set to, its interval, and the threads that wait for it."""

    def __init__(self) -> None:
        self.due_us: int | None = None
        self.interval_us = 0
        self.destroyed = False
        self.waiters: list[RobotThread] = []


class Alarms:
    """`hal.create_notifier` and its kin, in the time of one robot run. Status codes are always 0, success."""

    def __init__(self, threads: RobotThreads) -> None:
        self._threads = threads
        self._handles = count(_FIRST_HANDLE)
        self._alarms: dict[int, Alarm] = {}

    def __contains__(self, handle: object) -> bool:
        return handle in self._alarms

    def create(self) -> tuple[int, int]:
        handle = next(self._handles)
        self._alarms[handle] = Alarm()
        return handle, 0

    # The parameters have the HAL's names, by which they can be given. Times are in nanoseconds.

    def set(self, notifier_handle: int, alarm_time: int, interval_time: int, absolute: int, ack: int) -> int:
        alarm, now_us = self._alarms[notifier_handle], self._threads.clock.now_us
        due_us = timing.robot_us(alarm_time) if absolute else now_us + alarm_time // timing.NS_PER_US
        alarm.due_us, alarm.interval_us = due_us, interval_time // timing.NS_PER_US
        self._threads.notify(alarm.waiters)
        return 0

    def cancel(self, notifier_handle: int, ack: int) -> int:
        alarm = self._alarms[notifier_handle]
        alarm.due_us = None
        self._threads.notify(alarm.waiters)
        return 0

    def acknowledge(self, notifier_handle: int) -> int:
        return 0

    def destroy(self, notifier_handle: int) -> None:
        alarm = self._alarms.pop(notifier_handle)
        alarm.destroyed = True
        self._threads.notify(alarm.waiters)

    def overrun(self, notifier_handle: int) -> tuple[int, int]:
        return 0, 0

    def wait(self, handle: int, timeout: float | None) -> tuple[bool, bool]:
        """Return whether the alarm went off, and whether the time, in seconds, was out first."""
        __tracebackhide__ = True
        alarm, clock = self._alarms[handle], self._threads.clock
        give_up_us = None if timeout is None else clock.now_us + to_us(timeout)
        while not alarm.destroyed:
            due = alarm.due_us
            if due is not None and due <= clock.now_us:
                alarm.due_us = due + alarm.interval_us if alarm.interval_us else None
                return True, False
            if give_up_us is not None and give_up_us <= clock.now_us:
                return False, True
            next_us = min((each for each in (due, give_up_us) if each is not None), default=None)
            left = None if next_us is None else next_us - clock.now_us
            # Woken early when the alarm is set again; then this checks again.
            self._threads.wait(alarm.waiters, lambda: alarm.destroyed or alarm.due_us != due, left)  # noqa: B023
        return False, False


class Notifier(PeriodicThread):
    """Calls a function once after a delay, or periodically, on a thread of its own: `wpilib.Notifier` in robot time.

    :param handler: called at the notification time
    """

    def set_name(self, name: str) -> None:
        """Name the notifier, for debugging."""
        self._rename(name)

    def set_callback(self, handler: Callable[[], object]) -> None:
        """Call another function from now on."""
        self.use_handler(handler)

    def start_single(self, delay: float) -> None:
        """Call the handler once, `delay` seconds from now."""
        self._start(delay, None)

    def start_periodic(self, period: float) -> None:
        """Call the handler every `period` seconds, first one period from now."""
        self._start(period, to_us(period))

    def stop(self) -> None:
        """Stop the calls until it is started again. A call in progress is not interrupted."""
        self._stop()

    def get_overrun(self) -> int:
        """Return how many calls were left out because the one before took too long: none is."""
        return 0


def patches() -> list[Patch]:
    """Return the names of WPILib's to replace."""

    def notifier_call(name: str, ours: Callable[..., Any]) -> Patch:
        real = getattr(hal, name)

        def call(*args: object, **kwargs: object) -> Any:
            __tracebackhide__ = True
            run = active_run.run
            handle = args[0] if args else kwargs.get("notifier_handle")
            if run is not None and (handle is None or handle in run.alarms):
                return ours(run.alarms, *args, **kwargs)
            return real(*args, **kwargs)

        return Patch(hal, name, call)

    real_set_name = hal.set_notifier_name
    wait_for_event = event_waits.in_robot_time(wpiutil.sync.wait_for_object)

    def set_notifier_name(notifier_handle: int, name: str) -> Any:
        ours = active_run.run is not None and notifier_handle in active_run.run.alarms
        return 0 if ours else real_set_name(notifier_handle, name)

    def wait_for_object(handle: int, *timeout: float, **named: float) -> Any:
        __tracebackhide__ = True
        run: Any = active_run.run
        if run is None or handle not in run.alarms:
            return wait_for_event(handle, *timeout, **named)
        given = next(iter((*timeout, *named.values())), None)
        went_off, timed_out = run.alarms.wait(handle, given)
        return went_off if given is None else (went_off, timed_out)

    return [
        Patch(wpilib, "Notifier", Notifier),
        notifier_call("create_notifier", Alarms.create),
        notifier_call("set_notifier_alarm", Alarms.set),
        notifier_call("cancel_notifier_alarm", Alarms.cancel),
        notifier_call("acknowledge_notifier_alarm", Alarms.acknowledge),
        notifier_call("destroy_notifier", Alarms.destroy),
        notifier_call("get_notifier_overrun", Alarms.overrun),
        Patch(hal, "set_notifier_name", set_notifier_name),
        Patch(wpiutil.sync, "wait_for_object", wait_for_object),
    ]
