"""Where code of a process makes no progress, as the process that owns it reads it from the crash log."""

from __future__ import annotations

from dataclasses import dataclass

#: From this many seconds without progress on, the line is reported.
REPORTED_AFTER = 3.0


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

    def text(self, meanwhile: str = "") -> str:
        """Return this for the terminal.

        :param meanwhile: in which test, or in what, such as "tests/test_robot.py::test_teleop"
        """
        where = f" in {meanwhile}" if meanwhile else ""
        stands = "" if self.robot_time is None else f" (robot time stands at {self.robot_time:.2f} s)"
        return f"{self.place}: no progress for {self.seconds:.0f} s{where}{stands}"


class StandstillNotice:
    """Returns the text about each standstill of one process once, when it is time to print it.

    :param meanwhile: see `Standstill.text`
    """

    def __init__(self, meanwhile: str = "") -> None:
        self._meanwhile = meanwhile
        self._reported = False

    def look(self, now: Standstill | None) -> str | None:
        """Return what to print, if anything.

        :param now: the state of the process
        """
        if now is None:
            self._reported = False
        elif now.seconds >= REPORTED_AFTER and not self._reported:
            self._reported = True
            return now.text(self._meanwhile)
        return None
