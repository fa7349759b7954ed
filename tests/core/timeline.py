"""Robot threads on a clock of their own, and a log of what happens to them."""

from __future__ import annotations

import threading
from collections.abc import Callable

from pyfrc_core.runtime.clock import Clock
from pyfrc_core.runtime.threads import cooperative
from pyfrc_core.runtime.threads.robot_threads import RobotThreads


class Timeline:
    """A clock, the threads that live in its time, and the log.

    An entry of the log is the robot time in milliseconds and what happened: ``20 packet``.
    """

    def __init__(self) -> None:
        self.clock = Clock()
        self.threads = RobotThreads(self.clock)
        self.log: list[str] = []

    def note(self, what: object) -> None:
        """Add an entry at the robot time of this moment."""
        self.log.append(f"{self.clock.now_us / 1000:g} {what}")

    def at(self, milliseconds: float, rank: int, what: str) -> None:
        """Have the clock make an entry."""
        self.clock.at(round(milliseconds * 1000), rank, lambda: self.note(what))

    def thread(self, name: str, body: Callable[[], object]) -> threading.Thread:
        """Start a robot thread, whose first turn comes as soon as time moves."""
        thread = threading.Thread(target=body, name=name, daemon=True)
        cooperative.start_in_robot_time(thread)
        return thread

    def sleep(self, milliseconds: float) -> None:
        """Let the calling thread sleep in robot time."""
        self.threads.sleep_until(self.clock.now_us + round(milliseconds * 1000))

    def run_until(self, milliseconds: float) -> list[str]:
        """Let time pass, and return the whole log."""
        self.clock.run_until(round(milliseconds * 1000))
        return self.log
