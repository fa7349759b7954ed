"""What watches the robot's loop, in robot time: turns that take longer than its period are counted and reported."""

from __future__ import annotations

from typing import Any

from ...wpi import reports, robots
from ..clock import PACKET_US, Clock, to_us

#: Microseconds of robot time between two reports of a loop that is late again and again, as in WPILib.
BETWEEN_REPORTS_US = 1_000_000


class LoopOverruns:
    """Reports and counts turns of one robot's loop that took longer than its period, in robot time."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        #: How many there were, and the longest, in microseconds; one that still goes on is not among them.
        self.number = self.longest_us = 0
        self._told_us = -BETWEEN_REPORTS_US

    def count(self, took_us: int) -> None:
        """Count a turn that took this long, which is longer than its period."""
        self.number += 1
        self.longest_us = max(self.longest_us, took_us)

    def look(self, robot: Any, began_us: int) -> None:
        """Called when time has passed in a turn of the loop: say so if it was time that the robot did not have."""
        took_us = self._clock.now_us - began_us
        period = robots.period(robot, PACKET_US / 1_000_000)
        if took_us > to_us(period) and not robots.is_timed(robot):
            self.count(took_us)  # of a `TimedRobot`, its loop counts them
        if took_us < to_us(period) or began_us - self._told_us < BETWEEN_REPORTS_US:
            return
        self._told_us = began_us
        # The HAL drops a message with the same text as the one before, so this one contains the time.
        message = (
            f"Loop time of {period:.6f}s overrun: "
            f"the turn that began at {began_us / 1e6:.3f} s took {took_us / 1e6:.3f} s"
        )
        reports.report_error(message, type(robot).__name__)
        robots.print_epochs(robot)
