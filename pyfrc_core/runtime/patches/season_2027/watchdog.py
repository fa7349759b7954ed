"""`wpilib.Watchdog` in robot time, for robot code's own.

WPILib has one C++ thread for all of them, which follows the wall clock: what it has to say comes whenever the machine
lets it. So it is ended, and what it did is done here.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable

import hal
import wpilib

from ....wpi.season_2027 import watchdogs
from ...clock import WAKE_UP, Clock, to_us
from ...threads import cooperative
from ..loop_watchdog import BETWEEN_REPORTS_US

_ERROR_CODE = 1
_WPILibs = wpilib.Watchdog


class Watchdog(_WPILibs):
    """Calls a function when it has not been fed in time: `wpilib.Watchdog`, expiring in robot time.

    :param timeout: seconds within which it has to be fed
    :param callback: called when it was not, from wherever the time passes just then
    """

    def __init__(self, timeout: float, callback: Callable[[], None]) -> None:
        watchdogs.end_watchdog_thread()
        super().__init__(timeout, callback)
        self._callback = callback
        self._silent = self._expired = False
        self._told_us = -BETWEEN_REPORTS_US
        self._due_us: int | None = None
        self._alarm_us: int | None = None  # the clock's, which may be earlier: feeding does not move it

    def reset(self) -> None:
        """Feed the watchdog: restart its time, and enable it."""
        super().reset()
        self._begin()

    def enable(self) -> None:
        """Start its time."""
        super().enable()
        self._begin()

    def disable(self) -> None:
        """Stop its time: it no longer expires."""
        super().disable()
        self._due_us = None

    def set_timeout(self, timeout: float) -> None:
        """Set another time-out, in seconds, and restart its time."""
        super().set_timeout(timeout)
        self._begin()

    def is_expired(self) -> bool:
        """Whether it was not fed in time, since it was last enabled or fed."""
        return self._expired

    def suppress_timeout_message(self, suppress: bool) -> None:
        """Whether to print nothing when it expires: the callback may have more to say."""
        super().suppress_timeout_message(suppress)
        self._silent = suppress

    def _begin(self) -> None:
        threads = cooperative.scope.threads
        self._expired = False
        if threads is not None:
            self._due_us = threads.clock.now_us + to_us(self.get_timeout())
            self._set_alarm(threads.clock, self._due_us)

    def _set_alarm(self, clock: Clock, due_us: int) -> None:
        if self._alarm_us is not None and clock.now_us <= self._alarm_us <= due_us:
            return
        self._alarm_us = due_us
        this = weakref.ref(self)  # as in WPILib, one that was dropped is silent

        def alarm() -> None:
            __tracebackhide__ = True
            watchdog = this()
            if watchdog is not None and watchdog._alarm_us == due_us:
                watchdog._on_alarm(clock)

        clock.at(due_us, WAKE_UP, alarm)

    def _on_alarm(self, clock: Clock) -> None:
        __tracebackhide__ = True
        self._alarm_us = None
        if self._due_us is None:
            return
        if clock.now_us < self._due_us:
            self._set_alarm(clock, self._due_us)
            return
        self._due_us, self._expired = None, True
        if not self._silent and clock.now_us - self._told_us >= BETWEEN_REPORTS_US:
            self._told_us = clock.now_us
            message = f"Watchdog not fed within {self.get_timeout():.6f}s, at {clock.now:.3f} s"
            hal.send_error(False, _ERROR_CODE, message, "Watchdog", "", True)
        self._callback()
