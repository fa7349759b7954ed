"""What a simulation keeps of a run: everything it was told, and everything it did."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import replace
from heapq import merge
from importlib.metadata import version
from itertools import chain, takewhile
from operator import attrgetter
from pathlib import Path

from ...runtime.robot_time import to_us
from ...runtime.scripts.script import InputScript, Step, trace_beside
from ...runtime.trace import FORMAT
from ...text_files import write_whole
from .history import History, entries
from .messages import StationState, Update

_AT = attrgetter("at_us")


class Recording:
    """One run, from its start.

    :param past: what the robot was, or will be, told by a script
    :param known: whether what it does is told from the start, so that the whole has a hash
    """

    def __init__(self, past: InputScript, known: bool = True) -> None:
        self._past = past
        self._known = known
        self._steps: History[Step] = History()
        #: The last steps, from the one with the number `_changing_from`, which may still change.
        self._changing: tuple[Step, ...] = ()
        self._changing_from = 0
        self._lines: History[str] = History()
        self._stations: History[StationState] = History()
        #: How far it goes, in microseconds of robot time.
        self.length_us = 0

    def hear(self, update: Update) -> None:
        """Take in what has happened."""
        self.length_us = max(self.length_us, update.time_us)
        for step in self._changing[: update.steps_from - self._changing_from]:
            self._steps.append(step.at_us, step)
        self._changing, self._changing_from = update.steps, update.steps_from
        for line in update.lines:
            self._lines.append(to_us(json.loads(line)["t"]), line)
        if self._stations.last != update.station:
            self._stations.append(update.time_us, update.station)

    def script(self) -> InputScript:
        """What the robot was told, with the hash of what it did, if that is known."""
        return replace(self._script_until(self.length_us + 1), trace=self.digest())

    def _script_until(self, time_us: int) -> InputScript:
        """What the robot was told until then, and until one microsecond after the recording's end."""
        time_us = min(time_us, self.length_us + 1)
        told = [step for step in self._past.steps if step.at_us <= time_us]
        steps = takewhile(lambda step: step.at_us <= time_us, chain(entries(self._steps), self._changing))
        return replace(
            self._past,
            steps=tuple(merge(told, steps, key=_AT)),
            end_us=self.length_us + 1,
            packages={name: version(name) for name in ("pyfrc", "wpilib")},
            trace=None,
            story=(),
        )

    def digest(self) -> str | None:
        """The hash of what the robot did."""
        if not self._known:
            return None
        digest = hashlib.sha256()
        for line in entries(self._lines):
            digest.update(line.rstrip("\n").encode())
        return digest.hexdigest()

    def until(self, time_us: int) -> Recording:
        """The part until a moment, to go on from there."""
        part = Recording(self._script_until(time_us), self._known)
        part.length_us = time_us
        part._lines = self._lines.until(time_us)
        part._stations = self._stations.until(time_us)
        return part

    def again(self) -> Recording:
        """The same inputs for another robot program, which may do something else."""
        again = Recording(self.script(), known=False)
        again.length_us = self.length_us
        again._stations = self._stations.until(self.length_us)
        return again

    @property
    def past(self) -> InputScript:
        """What the robot is told by a script."""
        return self._past

    @property
    def lines(self) -> History[str]:
        """The trace until now: one line for each packet that changed something."""
        return self._lines

    @property
    def station(self) -> StationState:
        """How the driver station is at the end."""
        return self._stations.last or StationState()

    def save(self, file: Path) -> None:
        """Write the input script, and, where it is known, what the robot did beside it."""
        self.script().save(file)
        if self._known:
            write_whole(trace_beside(file), self._trace())

    def _trace(self) -> Iterator[str]:
        yield json.dumps({"format": FORMAT}) + "\n"
        yield from entries(self._lines)
        yield json.dumps({"sha256": self.digest()}) + "\n"
