"""Whether a program that was started runs: judged from its processes and its output.

`StartMonitor` is a state machine. It is given the time and what was seen; it reads no clock, looks at no process and
never waits, so that each order of events can be tested.

A roboRIO starts a program that has ended again at once. So a program that crashes is seen as a process that is replaced
by another; a program that runs keeps its process.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

#: The verdicts. `STARTING`: the process lives, and has not reported the end of its start within the limit.
#: `UNHEARD`: the process has lived for `unheard` seconds, and the console is silent, or the program reports no start.
RUNNING, ENDED, STARTING, UNHEARD = "running", "ended", "starting", "unheard"
VERDICTS = (RUNNING, ENDED, STARTING, UNHEARD)

#: WPILib's report that `robotInit` is over.
STARTED = "Robot program startup complete"
_TRACEBACK = "Traceback (most recent call last):"
#: WPILib's report that the program is over. A thread of the program may keep its process alive all the same.
_OVER = ("The robot program quit unexpectedly", "Unexpected return from startCompetition()")
#: What a new process prints before any robot code can report that it has started.
_BEGINNING = re.compile(r"Robot program starting|WPILib version \d|registered SIGUSR2 for PID \d")

#: Seconds for which a program has to live on after its start: half of what the start took, within these bounds. A slow
#: robot needs longer for its first loop as well. The shortest sees a crash half a second after a start of no time.
_SHORTEST_TRIAL, _LONGEST_TRIAL = 0.6, 2.0
#: Seconds for which it has to live on after a traceback. That need not be its end: code logs errors that it has caught.
_AFTER_TRACEBACK = 3.0
#: Seconds after the restart in which one process may be replaced without a traceback: the robot's kill script and its
#: supervisor may both start the program.
_DOUBLE_START = 2.0
#: Seconds without any process after which the robot counts as not starting the program; and the same after a traceback.
_ABSENT, _ABSENT_AFTER_TRACEBACK = 10.0, 2.0
#: Seconds in which the last output of an ended program may still arrive.
_LAST_OUTPUT = 0.5
#: Seconds in which output that arrives may still be of the process before.
_LATE_OUTPUT = 0.3


class StartMonitor:
    """Judges the start of a program.

    :param old:     the processes of the program before, from a moment before the restart
    :param reports: whether the program reports that `robotInit` is over
    """

    def __init__(self, old: Iterable[int], reports: bool = True) -> None:
        self._old = frozenset(old)
        self._reports = reports
        #: The program's process, while there is one.
        self.process: int | None = None
        #: When it was first seen.
        self._since = 0.0
        self._others: set[int] = set()  # its children, which may outlive it
        #: Whether anything was printed by the new program.
        self.heard = False
        #: Whether a process was ever seen.
        self.seen = False
        self._old_seen = float("-inf")
        #: For how many seconds a program was seen that has ended since: the one that decides the verdict.
        self.lived = 0.0
        self._restarted: float | None = None
        self._absent: float | None = None
        self._ends = 0
        self._dead: float | None = None
        self._forget()

    def _forget(self) -> None:
        """The evidence about the current process."""
        self._begun = False
        self._started: float | None = None
        self._traceback: float | None = None
        self._over: float | None = None

    def restarted(self, now: float) -> None:
        """The kill script has ended: from now on, a process that ends is evidence."""
        self._restarted = now

    @property
    def is_restarted(self) -> bool:
        """Whether the kill script has ended."""
        return self._restarted is not None

    def see(self, now: float, processes: Iterable[int], text: str = "") -> bool:
        """Take in one look at the robot.

        :param processes: those of any robot program, old and new
        :param text: the lines that were printed since the last look, and before `processes` were looked at
        :return: whether the text is the new program's
        """
        found, lines = frozenset(processes), text.splitlines()
        if found & self._old:
            lines, self._old_seen = [], now
        self.heard = self.heard or bool(lines)
        fresh = found - self._old - self._others
        if self.process is not None and self.process not in fresh:
            beginning = _last_beginning(lines)
            self._read(now, lines[:beginning])
            self._end(now)
            lines = lines[beginning:]
        if self.process is not None:
            self._read(now, lines)
        elif fresh:
            self._begin(now, min(fresh))
            self._read(now, lines[_last_beginning(lines) :])  # what stands before may be of the process before
        elif now - self._old_seen > _LATE_OUTPUT:
            self._read(now, lines)
        self._others |= fresh.difference([self.process])
        return now > self._old_seen

    def _begin(self, now: float, process: int) -> None:
        self._forget()
        self.process, self._since, self.seen, self._absent = process, now, True, None

    def _end(self, now: float) -> None:
        crashed = self._traceback is not None or self._over is not None
        if self._dead is None:
            self.lived = (self._over or now) - self._since
            if self._restarted is not None and (crashed or self._ends or now - self._restarted >= _DOUBLE_START):
                self._dead = now
        self._ends += 1
        self.process, self._absent = None, now

    def _read(self, now: float, lines: list[str]) -> None:
        for line in lines:
            if _BEGINNING.search(line):
                self._forget()
                self._begun = True
            elif STARTED in line:
                if self._begun or now - self._since > _LATE_OUTPUT:
                    self._started = self._started or now
            elif _TRACEBACK in line:
                self._traceback = now
            elif self._begun and self._over is None and any(words in line for words in _OVER):
                self._over = now
                self.lived = now - self._since

    def verdict(self, now: float, limit: float, unheard: float) -> str | None:
        """Return what has become of the program, or None while that is open.

        :param limit:   seconds after the restart at which a start is reported as slow
        :param unheard: seconds of its process after which a program is judged by that alone, if its console is silent
            or it reports no start
        """
        if self._restarted is None:
            return None
        if self._dead is not None:
            return ENDED if now - self._dead >= _LAST_OUTPUT else None
        if self.process is None:
            return self._absent_verdict(now, limit)
        if self._over is not None:
            return ENDED if now - self._over >= 2 * _LAST_OUTPUT else None
        left = self.trial_left(now)
        if left is not None:
            return None if left else RUNNING
        if not (self.heard and self._reports) and now - self._since >= unheard and not self._proof_left(now):
            return UNHEARD
        return STARTING if now - self._restarted >= limit else None

    def _absent_verdict(self, now: float, limit: float) -> str | None:
        assert self._restarted is not None
        since = max(self._restarted, self._absent or 0.0)
        patience = _ABSENT if self._traceback is None else _ABSENT_AFTER_TRACEBACK
        return ENDED if now - since >= min(patience, limit) else None

    def trial_left(self, now: float) -> float | None:
        """Return for how many seconds a program has to live on; None before it has started, and after its end."""
        if self._started is None or self.process is None or self._over is not None or self._dead is not None:
            return None
        trial = min(_LONGEST_TRIAL, max(_SHORTEST_TRIAL, (self._started - self._since) / 2))
        if self._ends:  # one was replaced already
            trial = _LONGEST_TRIAL
        return max(0.0, self._started + trial - now, self._proof_left(now))

    def _proof_left(self, now: float) -> float:
        """For how many seconds a process has to live on after a traceback, if there was one."""
        return 0.0 if self._traceback is None else max(0.0, self._traceback + _AFTER_TRACEBACK - now)

    def seconds(self, now: float) -> float:
        """Return the seconds since the restart."""
        return 0.0 if self._restarted is None else now - self._restarted

    def age(self, now: float) -> float:
        """Return for how many seconds the current process has been seen; 0 without one."""
        return now - self._since if self.process is not None else 0.0


def _last_beginning(lines: list[str]) -> int:
    """The index of the last line with which a process begins; the number of lines without one."""
    return max((index for index, line in enumerate(lines) if _BEGINNING.search(line)), default=len(lines))
