"""A robot with a loop of its own that never takes in what the driver station sends.

WPILib's own loops call `wpilib.DriverStation.refreshData()` in each turn; in a plain `RobotBase` the user has to.
Without it the robot stays disabled for good: here as on the field, but a test of it passes.
"""

from __future__ import annotations

from pathlib import Path

from ...wpi import names, robots, station
from ..robot import RobotRun

#: A robot that was enabled at this many looks, 0.04 s apart, should know it, however long it takes to start.
_LOOKS = 125


def explain_missing_refresh(run: RobotRun) -> str | None:
    """Return a sentence about a robot that is enabled and does not see it; None for all others."""
    if _sees_mode(run) or not station.is_enabled():
        return None
    robot = type(run.robot)
    code = getattr(getattr(robot, names.MAIN), "__code__", None)
    place = f"{Path(code.co_filename).name}:{code.co_firstlineno}: " if code is not None else ""
    return (
        f"{place}{robot.__name__} still finds itself disabled while the driver station has enabled it: "
        f"its loop does not call {names.REFRESH}. Call that at the beginning of each turn."
    )


class RefreshCheck:
    """The same for a run that goes on: to be asked again and again, until there is an answer."""

    def __init__(self, run: RobotRun) -> None:
        self._run = run
        self._looks = 0

    def look(self) -> str | None:
        """Return the sentence, once, when the robot has been enabled for some time."""
        if self._looks > _LOOKS:
            return None
        if _sees_mode(self._run):
            self._looks = _LOOKS + 1
        elif station.is_enabled():
            self._looks += 1
            if self._looks > _LOOKS:
                return explain_missing_refresh(self._run)
        return None


def _sees_mode(run: RobotRun) -> bool:
    """Whether the robot has been found enabled in its own view, or has a loop that a library has written."""
    if run.own_loop is None or robots.has_loop_of_a_library(run.robot):
        return True
    return station.robot_is_enabled()
