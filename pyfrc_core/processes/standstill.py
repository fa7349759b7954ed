"""Where a process makes no progress: code of the robot, as the crash log says, or a start that takes seconds."""

from __future__ import annotations

from dataclasses import dataclass

#: From this many seconds without progress on, the line is reported.
REPORTED_AFTER = 3.0


def slow_start(seconds: float, meanwhile: str = "") -> str:
    """Return the text about a process that has been loading its modules for this many wall seconds."""
    where = f" for {meanwhile}" if meanwhile else ""
    return (
        f"still loading WPILib and other libraries{where}, after {seconds:.0f} s"
        " (longest at the first start, and where a virus scanner reads each file)"
    )


@dataclass(frozen=True)
class Standstill:
    """Code that makes no progress.

    :param seconds: for how long, in wall seconds
    :param place: the user's line, such as ``robot.py:12``; or what is known instead
    :param robot_time: in seconds; None when no robot runs
    """

    seconds: float
    place: str
    robot_time: float | None = None
    #: Whether no Python code of the process has run for so long that it never will.
    hopeless: bool = False
    #: Whether the process is still loading what it needs, and no code of the user's runs.
    loading: bool = False

    def text(self, meanwhile: str = "") -> str:
        """Return this for the terminal.

        :param meanwhile: in which test, or in what, such as "tests/test_robot.py::test_teleop"
        """
        if self.loading:
            return slow_start(self.seconds, meanwhile)
        where = f" in {meanwhile}" if meanwhile else ""
        stands = "" if self.robot_time is None else f" (robot time stands at {self.robot_time:.2f} s)"
        return f"{self.place}: no progress for {self.seconds:.0f} s{where}{stands}"


def loading_for(seconds: float) -> Standstill | None:
    """Return a process's start as a standstill, when it has lasted for so many wall seconds that it is reported."""
    return Standstill(seconds, "", loading=True) if seconds >= REPORTED_AFTER else None


class StandstillNotice:
    """Returns the text about each standstill of one process once, when it is time to print it.

    :param meanwhile: see `Standstill.text`
    :param starts: whether a start is reported, at which robot time is 0
    """

    def __init__(self, meanwhile: str = "", starts: bool = True) -> None:
        self._meanwhile, self._starts = meanwhile, starts
        self._reported = False

    def look(self, now: Standstill | None) -> str | None:
        """Return what to print, if anything.

        :param now: the state of the process
        """
        if now is None or (now.robot_time == 0 and not self._starts):
            self._reported = False
        elif now.seconds >= REPORTED_AFTER and not self._reported:
            self._reported = True
            return now.text(self._meanwhile)
        return None
