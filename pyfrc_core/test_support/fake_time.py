"""Control over the time a robot under test is using."""

from __future__ import annotations

from ..runtime.clock import DEFAULT_TIME_LIMIT, to_us
from ..runtime.exceptions import TestEnded, TestFroze, TestRanTooLong
from ..runtime.robot import RobotRun

__all__ = ["FakeTime", "TestEnded", "TestFroze", "TestRanTooLong"]


class FakeTime:
    """Keeps track of time for robot code being tested, and makes sure the driver station's packets come in.

    Do not create this object: your test gets it as the ``fake_time`` fixture. All times are seconds of robot time,
    which starts at 0 and moves only when the robot, or your test, lets it.

    A thread of the robot may use it, too: a thread that increments the time sleeps for as long, as with `time.sleep`.
    A thread that does not live in robot time can only ask for the time and set the limit.
    """

    def __init__(self, run: RobotRun | None = None) -> None:
        self.run = RobotRun() if run is None else run

    def get(self) -> float:
        """The current time for the robot, in seconds."""
        return self.run.clock.now

    def increment_new_packet(self) -> None:
        """Increment time enough to where the new driver-station packet comes in (the next multiple of 20 ms)."""
        __tracebackhide__ = True
        self.run.next_packet()

    def increment_time_by(self, time: float) -> None:
        """Increments time by some number of seconds; the robot, if it runs, does what it does in that time.

        :raises TestRanTooLong: when that goes past the time limit
        :raises ValueError: when the time is negative
        """
        __tracebackhide__ = True
        if time < 0:
            raise ValueError(f"time cannot go back: increment_time_by({time!r})")
        self.run.run_until(self.run.clock.now_us + to_us(time))

    def initialize(self) -> None:
        """Initializes fake time: from now on the clock stands at 0 and moves only when told to.

        :raises RuntimeError: when the robot runs already
        """
        self.run.check_can_set_time_back()
        self.run.clock.initialize()

    def reset(self) -> None:
        """Resets the fake time to zero, and sets the time limit to default.

        :raises RuntimeError: when the robot runs already
        """
        self.initialize()
        self.set_time_limit(DEFAULT_TIME_LIMIT)

    def set_time_limit(self, time_limit: float) -> None:
        """Sets the amount of time that a robot will run, in seconds; 500 by default.

        When time is incremented past this time, a `TestRanTooLong` is thrown.
        """
        self.run.clock.limit_us = to_us(time_limit)
