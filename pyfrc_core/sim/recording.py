"""What a simulation keeps of a run: everything it was told, and everything it did."""

from __future__ import annotations

import hashlib
import json
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import replace
from heapq import merge
from importlib.metadata import version
from operator import attrgetter
from pathlib import Path

from ..runtime.clock import to_us
from ..runtime.scripts.files import trace_beside
from ..runtime.scripts.script import InputScript, Step
from ..runtime.trace import FORMAT
from ..text_files import write_whole
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
        self._steps: list[Step] = []
        self._lines: list[tuple[int, str]] = []
        self._stations: list[tuple[int, StationState]] = []
        #: How far it goes, in microseconds of robot time.
        self.length_us = 0

    def hear(self, update: Update) -> None:
        """Take in what has happened."""
        self.length_us = max(self.length_us, update.time_us)
        del self._steps[update.steps_from :]
        self._steps += update.steps
        self._lines += ((to_us(json.loads(line)["t"]), line) for line in update.lines)
        if not self._stations or self._stations[-1][1] != update.station:
            self._stations.append((update.time_us, update.station))

    def script(self) -> InputScript:
        """What the robot was told, with the hash of what it did, if that is known."""
        end_us = self.length_us + 1
        told = [step for step in self._past.steps if step.at_us <= end_us]
        return replace(
            self._past,
            steps=tuple(merge(told, self._steps, key=_AT)),
            end_us=end_us,
            packages={name: version(name) for name in ("pyfrc", "wpilib")},
            trace=self.digest(),
            story=(),
        )

    def digest(self) -> str | None:
        """The hash of what the robot did."""
        if not self._known:
            return None
        digest = hashlib.sha256()
        for _, line in self._lines:
            digest.update(line.rstrip("\n").encode())
        return digest.hexdigest()

    def until(self, time_us: int) -> Recording:
        """The part until a moment, to go on from there."""
        script = self.script()
        past = replace(script, steps=tuple(step for step in script.steps if step.at_us <= time_us), trace=None)
        part = Recording(past, self._known)
        part.length_us = time_us
        part._lines = self._lines[: bisect_right(self._lines, time_us, key=lambda line: line[0])]
        part._stations = [(at_us, station) for at_us, station in self._stations if at_us <= time_us]
        return part

    def again(self) -> Recording:
        """The same inputs for another robot program, which may do something else."""
        again = Recording(self.script(), known=False)
        again.length_us = self.length_us
        again._stations = self._stations
        return again

    @property
    def past(self) -> InputScript:
        """What the robot is told by a script."""
        return self._past

    @property
    def station(self) -> StationState:
        """How the driver station is at the end."""
        return self._stations[-1][1] if self._stations else StationState()

    def save(self, file: Path) -> None:
        """Write the input script, and, where it is known, what the robot did beside it."""
        self.script().save(file)
        if self._known:
            write_whole(trace_beside(file), self._trace())

    def _trace(self) -> Iterator[str]:
        yield json.dumps({"format": FORMAT}) + "\n"
        for _, line in self._lines:
            yield line
        yield json.dumps({"sha256": self.digest()}) + "\n"
