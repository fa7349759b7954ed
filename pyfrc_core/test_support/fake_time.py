"""Control over robot time in a test."""

from __future__ import annotations

import math
from numbers import Real

from ..runtime.clock import NO_LIMIT_US, to_us
from ..runtime.exceptions import TestEnded, TestFroze, TestRanTooLong
from ..runtime.robot import RobotRun

__all__ = ["FakeTime", "TestEnded", "TestFroze", "TestRanTooLong"]


class FakeTime:
    """Keeps track of time for the robot code under test, and delivers the driver station's packets.

    Do not create this object: your test gets it as the ``fake_time`` fixture. All times are seconds of robot time,
    which starts at 0 and advances only when the robot or your test advances it.

    The robot's threads may use it, too: a thread that increments the time sleeps that long, as with `time.sleep`. A
    thread outside robot time can only read the time and set the limit.
    """

    def __init__(self, run: RobotRun | None = None) -> None:
        self.run = RobotRun() if run is None else run

    def get(self) -> float:
        """Return the current robot time, in seconds."""
        return self.run.clock.now

    def increment_new_packet(self) -> None:
        """Increment time to the next driver-station packet (the next multiple of 20 ms)."""
        __tracebackhide__ = True
        self.run.next_packet()

    def increment_time_by(self, time: float) -> None:
        """Increment time by this many seconds; a running robot runs during that time. Time never goes back.

        :raises TestRanTooLong: when time passes the time limit
        :raises ValueError: when the time is negative or no finite number
        """
        __tracebackhide__ = True
        self.run.run_until(self.run.clock.now_us + duration_us(time, f"increment_time_by({time!r})"))

    def initialize(self) -> None:
        """Initialize fake time: set the clock to 0, to advance only when it is incremented.

        :raises RuntimeError: when the robot runs already
        """
        self.run.check_can_set_time_back()
        self.run.clock.initialize()

    def reset(self) -> None:
        """Reset the time to zero, and the time limit to its default.

        :raises RuntimeError: when the robot runs already
        """
        self.initialize()

    def set_time_limit(self, time_limit: float | None) -> None:
        """Set how long a robot may run, in seconds; 500 by default, None for no limit.

        When time passes the limit, `TestRanTooLong` is raised.

        :raises ValueError: when the limit is negative or no finite number
        """
        self.time_limit = time_limit

    @property
    def time_limit(self) -> float | None:
        """How long a robot may run, in seconds; None for no limit."""
        limit_us = self.run.clock.limit_us
        return None if limit_us == NO_LIMIT_US else limit_us / 1_000_000

    @time_limit.setter
    def time_limit(self, seconds: float | None) -> None:
        __tracebackhide__ = True
        limit_us = NO_LIMIT_US
        if seconds is not None:
            limit_us = duration_us(seconds, f"set_time_limit({seconds!r})", ", or None for no limit")
        self.run.clock.limit_us = limit_us


def duration_us(seconds: float, call: str, alternative: str = "") -> int:
    """Return a duration in whole microseconds.

    :param call: the call that it is the argument of, for the error message
    :param alternative: what may be given instead, for the error message
    :raises ValueError: when it is negative or no finite number
    """
    __tracebackhide__ = True
    if isinstance(seconds, Real) and 0 <= seconds < math.inf:
        return to_us(seconds)
    raise ValueError(f"{call}: needs a number of seconds that is not negative{alternative}")
