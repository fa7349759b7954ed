"""Decides from a program's processes and output whether it has started.

`StartMonitor` is a state machine. Its caller passes the time and observations. It reads no clock, inspects no process
and never waits, so that tests can cover every order of events.

A robot restarts a program immediately after its end. A crashing program is therefore visible as a process that is
replaced by another. A working program keeps its process.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

#: The verdicts. `STARTING`: the process runs, and has not reported the end of its start within the time limit.
#: `UNHEARD`: the process has run for `unheard` seconds, and the console is silent or the program does not report.
RUNNING, ENDED, STARTING, UNHEARD = "running", "ended", "starting", "unheard"
VERDICTS = (RUNNING, ENDED, STARTING, UNHEARD)

#: WPILib's report that `robotInit` is over.
STARTED = "Robot program startup complete"
_TRACEBACK = "Traceback (most recent call last):"
#: WPILib's report that the program has ended. A thread of the program may still keep its process alive.
_OVER = ("The robot program quit unexpectedly", "Unexpected return from startCompetition()")
#: Output of a new process, before robot code can report its start.
_BEGINNING = re.compile(r"Robot program starting|WPILib version \d|registered SIGUSR2 for PID \d")

#: Bounds, in seconds, of the trial period after the start, which is half as long as the start itself. A slow robot also
#: needs longer for its first loop. The minimum detects a crash 0.5 s after a very short start.
_MIN_TRIAL, _MAX_TRIAL = 0.6, 2.0
#: Seconds for which it must run after a traceback. A traceback does not always mean a crash: code logs caught errors.
_AFTER_TRACEBACK = 3.0
#: Seconds after the restart in which one process may be replaced without a traceback, since the stop command and the
#: robot's supervisor may both start the program.
_DOUBLE_START = 2.0
#: Seconds without a process after which the program counts as ended; the second value applies after a traceback.
_ABSENT, _ABSENT_AFTER_TRACEBACK = 10.0, 2.0
#: Seconds to wait for the last output of an ended program.
_FINAL_OUTPUT = 0.5
#: Seconds after the end of a process in which its output may still arrive.
_LATE_OUTPUT = 0.3


class StartMonitor:
    """Observes the start of a program and gives a verdict.

    :param old:     processes of the old program, from just before the restart
    :param reports: returns whether the program reports the end of `robotInit`; called only if that is late
    """

    def __init__(self, old: Iterable[int], reports: Callable[[], bool] = lambda: True) -> None:
        self._old = frozenset(old)
        self._reports = reports
        #: The program's current process, if any.
        self.process: int | None = None
        #: When it was first seen.
        self._since = 0.0
        self._others: set[int] = set()  # its child processes, which may outlive it
        #: Whether output of the new program was received.
        self.has_output = False
        #: Whether a process of the new program was ever found.
        self.seen = False
        self._old_seen = float("-inf")
        #: For how many seconds the ended process that decides the verdict has run.
        self.lived = 0.0
        self._restarted: float | None = None
        self._absent: float | None = None
        self._ends = 0
        self._dead: float | None = None
        self._forget()

    def _forget(self) -> None:
        """Reset the observations of the current process."""
        self._begun = False
        self._started: float | None = None
        self._traceback: float | None = None
        self._over: float | None = None

    def restarted(self, now: float) -> None:
        """Record that the stop command has ended: from now on, the end of a process counts."""
        self._restarted = now

    @property
    def is_restarted(self) -> bool:
        """Return whether the stop command has ended."""
        return self._restarted is not None

    def observe(self, now: float, processes: Iterable[int], text: str = "") -> bool:
        """Record one observation.

        :param now: the time in seconds
        :param processes: processes of any robot program, old and new
        :param text: lines received since the last observation, read before `processes` were listed
        :return: whether the text is output of the new program
        """
        found, lines = frozenset(processes), text.splitlines()
        if found & self._old:
            lines, self._old_seen = [], now
        self.has_output = self.has_output or bool(lines)
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
            self._read(now, lines[_last_beginning(lines) :])  # earlier lines may belong to the previous process
        elif now - self._old_seen > _LATE_OUTPUT:
            self._read(now, lines)
        self._others |= fresh.difference([self.process])
        return now > self._old_seen

    def _end_before(self) -> float:
        """Return when the previous process was last seen, or the current one first, if that is not known."""
        return self._since if self._ends else self._old_seen

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
                if self._begun or now - self._end_before() > _LATE_OUTPUT:
                    self._started = self._started or now
            elif _TRACEBACK in line:
                self._traceback = now
            elif self._begun and self._over is None and any(words in line for words in _OVER):
                self._over = now
                self.lived = now - self._since

    def verdict(self, now: float, limit: float, unheard: float) -> str | None:
        """Return the verdict, or None while it is undecided.

        :param limit:   seconds after the restart at which a start is reported as slow
        :param unheard: seconds after which a program is judged by its process alone, if the console is silent or the
            program does not report its start
        """
        if self._restarted is None:
            return None
        if self._dead is not None:
            return ENDED if now - self._dead >= _FINAL_OUTPUT else None
        if self.process is None:
            return self._absent_verdict(now, limit)
        if self._over is not None:
            return ENDED if now - self._over >= 2 * _FINAL_OUTPUT else None
        left = self.trial_left(now)
        if left is not None:
            return None if left else RUNNING
        is_judged_alone = now - self._since >= unheard and not self._proof_left(now)
        if is_judged_alone and not (self.has_output and self._reports()):
            return UNHEARD
        return STARTING if now - self._restarted >= limit else None

    def _absent_verdict(self, now: float, limit: float) -> str | None:
        assert self._restarted is not None
        since = max(self._restarted, self._absent or 0.0)
        patience = _ABSENT if self._traceback is None else _ABSENT_AFTER_TRACEBACK
        return ENDED if now - since >= min(patience, limit) else None

    def trial_left(self, now: float) -> float | None:
        """Return the remaining seconds of the trial period; None before the start and after the end."""
        if self._started is None or self.process is None or self._over is not None or self._dead is not None:
            return None
        trial = min(_MAX_TRIAL, max(_MIN_TRIAL, (self._started - self._since) / 2))
        if self._ends:  # a process was already replaced
            trial = _MAX_TRIAL
        return max(0.0, self._started + trial - now, self._proof_left(now))

    def _proof_left(self, now: float) -> float:
        """Return for how many seconds a process must still run after a traceback."""
        return 0.0 if self._traceback is None else max(0.0, self._traceback + _AFTER_TRACEBACK - now)

    def seconds(self, now: float) -> float:
        """Return the seconds since the restart."""
        return 0.0 if self._restarted is None else now - self._restarted

    def age(self, now: float) -> float:
        """Return for how many seconds the current process has been observed; 0 without one."""
        return now - self._since if self.process is not None else 0.0


def _last_beginning(lines: list[str]) -> int:
    """Return the index of the last line that a new process prints first, or the number of lines if there is none."""
    return max((index for index, line in enumerate(lines) if _BEGINNING.search(line)), default=len(lines))
