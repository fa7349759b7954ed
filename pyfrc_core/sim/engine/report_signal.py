"""The condition that wakes front ends."""

from __future__ import annotations

import threading


class ReportSignal(threading.Condition):
    """A condition that counts its notifications: a thread that was busy during one does not wait for the next one."""

    def __init__(self) -> None:
        super().__init__()
        #: The number of notifications so far.
        self.count = 0

    def notify_all(self) -> None:
        """Wake all threads that wait."""
        self.count += 1
        super().notify_all()

    def wait_after(self, count: int, timeout: float) -> None:
        """Wait until there were more notifications than `count`.

        :param timeout: in wall seconds
        """
        with self:
            self.wait_for(lambda: self.count > count, timeout)
