"""`wpilib.Watchdog` in robot time, for robot code's own: see `expiry`."""

from __future__ import annotations

from collections.abc import Callable

import hal
import wpilib

from ....wpi import watchdogs
from ..expiry import Expiry

_ERROR_CODE = 1


class Watchdog(wpilib.Watchdog):
    """Calls a function when it has not been fed in time: `wpilib.Watchdog`, expiring in robot time.

    :param timeout: seconds within which it has to be fed
    :param callback: called when it was not, from wherever the time passes just then
    """

    def __init__(self, timeout: float, callback: Callable[[], None]) -> None:
        watchdogs.end_watchdog_thread()
        super().__init__(timeout, callback)
        self._expiry = Expiry(callback, _warn)

    def reset(self) -> None:
        """Feed the watchdog: restart its time, and enable it."""
        super().reset()
        self._expiry.begin(self.getTimeout())

    def enable(self) -> None:
        """Start its time."""
        super().enable()
        self._expiry.begin(self.getTimeout())

    def disable(self) -> None:
        """Stop its time: it no longer expires."""
        super().disable()
        self._expiry.stop()

    def setTimeout(self, timeout: float) -> None:
        """Set another time-out, in seconds, and restart its time."""
        super().setTimeout(timeout)
        self._expiry.begin(timeout)

    def isExpired(self) -> bool:
        """Whether it was not fed in time, since it was last enabled or fed."""
        return self._expiry.expired

    def suppressTimeoutMessage(self, suppress: bool) -> None:
        """Whether to print nothing when it expires: the callback may have more to say."""
        super().suppressTimeoutMessage(suppress)
        self._expiry.silent = suppress


def _warn(message: str) -> None:
    hal.sendError(False, _ERROR_CODE, False, message, "Watchdog", "", True)
