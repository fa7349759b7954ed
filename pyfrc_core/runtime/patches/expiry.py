"""When a watchdog expires, in robot time: what each season's `watchdog.Watchdog` has in common.

WPILib has one C++ thread for all watchdogs, which follows the wall clock: what it has to say comes whenever the machine
lets it. So it is ended (`wpi.watchdogs`), and what it did is done here.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable

from ..clock import WAKE_UP, Clock, to_us
from ..threads import cooperative
from .loop_watchdog import BETWEEN_REPORTS_US


class Expiry:
    """The time of one watchdog, to which it belongs: as in WPILib, one that was dropped is silent.

    :param callback: called when it expires, from wherever the time passes just then
    :param warn: called before with a message, at most once a second, unless the watchdog is silent
    """

    def __init__(self, callback: Callable[[], object], warn: Callable[[str], object]) -> None:
        self._callback, self._warn = callback, warn
        #: Whether to report nothing.
        self.silent = False
        #: Whether it was not fed in time, since it was last enabled or fed.
        self.expired = False
        self._timeout = 0.0
        self._reported_us = -BETWEEN_REPORTS_US
        self._due_us: int | None = None
        self._alarm_us: int | None = None  # the clock's, which may be earlier: feeding does not move it

    def begin(self, timeout: float) -> None:
        """Restart its time.

        :param timeout: seconds from now
        """
        threads = cooperative.scope.threads
        self.expired, self._timeout = False, timeout
        if threads is not None:
            self._due_us = threads.clock.now_us + to_us(timeout)
            self._set_alarm(threads.clock, self._due_us)

    def stop(self) -> None:
        """Stop its time: it no longer expires."""
        self._due_us = None

    def _set_alarm(self, clock: Clock, due_us: int) -> None:
        if self._alarm_us is not None and clock.now_us <= self._alarm_us <= due_us:
            return
        self._alarm_us = due_us
        this = weakref.ref(self)

        def alarm() -> None:
            __tracebackhide__ = True
            expiry = this()
            if expiry is not None and expiry._alarm_us == due_us:
                expiry._on_alarm(clock)

        clock.at(due_us, WAKE_UP, alarm)

    def _on_alarm(self, clock: Clock) -> None:
        __tracebackhide__ = True
        self._alarm_us = None
        if self._due_us is None:
            return
        if clock.now_us < self._due_us:
            self._set_alarm(clock, self._due_us)
            return
        self._due_us, self.expired = None, True
        if not self.silent and clock.now_us - self._reported_us >= BETWEEN_REPORTS_US:
            self._reported_us = clock.now_us
            self._warn(f"Watchdog not fed within {self._timeout:.6f}s, at {clock.now:.3f} s")
        self._callback()
