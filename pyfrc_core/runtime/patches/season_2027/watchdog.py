"""`wpilib.Watchdog` in robot time, for robot code's own: see `expiry`."""

from __future__ import annotations

from collections.abc import Callable

import hal
import wpilib

from ....wpi.season_2027 import watchdogs
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
        self._expiry.begin(self.get_timeout())

    def enable(self) -> None:
        """Start its time."""
        super().enable()
        self._expiry.begin(self.get_timeout())

    def disable(self) -> None:
        """Stop its time: it no longer expires."""
        super().disable()
        self._expiry.stop()

    def set_timeout(self, timeout: float) -> None:
        """Set another time-out, in seconds, and restart its time."""
        super().set_timeout(timeout)
        self._expiry.begin(timeout)

    def is_expired(self) -> bool:
        """Whether it was not fed in time, since it was last enabled or fed."""
        return self._expiry.expired

    def suppress_timeout_message(self, suppress: bool) -> None:
        """Whether to print nothing when it expires: the callback may have more to say."""
        super().suppress_timeout_message(suppress)
        self._expiry.silent = suppress


def _warn(message: str) -> None:
    hal.send_error(False, _ERROR_CODE, message, "Watchdog", "", True)
