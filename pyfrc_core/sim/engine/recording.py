"""The recording of a run: all its inputs, and everything that it did."""

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
from ...runtime.scripts.sensors import released
from ...runtime.scripts.trace import FORMAT
from ...runtime.scripts.trace_lines import Change, lines_of
from ...text_files import write_whole
from .history import History, entries
from .messages import RobotReport, StationState, Update

_AT = attrgetter("at_us")


class Recording:
    """One run, from its start.

    :param past: the script of the run's first part, which was or will be replayed
    :param known: whether the trace is complete from the start, so that it has a hash
    """

    def __init__(self, past: InputScript, known: bool = True) -> None:
        self.past, self._known = past, known
        self._steps: History[Step] = History()
        #: The last steps, from the one with the number `_changing_from`, which may still change.
        self._changing: tuple[Step, ...] = ()
        self._changing_from = 0
        #: What the robot did until now: the changes of each packet, and those of NetworkTables, if they are reported.
        self.changes: History[Change] = History()
        self.network_changes: History[Change] = History()
        self._stations: History[StationState] = History()
        #: The end of the recording, in microseconds of robot time.
        self.length_us = 0
        #: Whether another program has yet to replay the inputs, so that what it does there is not known.
        self.is_open = False

    def add(self, report: RobotReport) -> None:
        """Add what has happened since the last report."""
        for change in report.changes:
            self.changes.append(to_us(change.time), change)
        for change in report.network_changes:
            self.network_changes.append(to_us(change.time), change)
        if isinstance(report, Update):
            self._add_inputs(report)

    def _add_inputs(self, update: Update) -> None:
        self.is_open = False
        # What was chosen while time stood comes after that moment, as in the script.
        chosen_us = update.time_us + (update.time_us == self.length_us and self._stations.last is not None)
        self.length_us = max(self.length_us, update.time_us)
        for step in self._changing[: update.steps_from - self._changing_from]:
            self._steps.append(step.at_us, step)
        self._changing, self._changing_from = update.steps, update.steps_from
        if self._stations.last != update.station:
            self._stations.append(chosen_us, update.station)

    def script(self) -> InputScript:
        """Return the robot's inputs, with the hash of what it did, if that is known."""
        return replace(self.inputs(), trace=self.digest())

    def inputs(self, until_us: int | None = None) -> InputScript:
        """Return the robot's inputs, without a hash.

        :param until_us: an earlier end, in microseconds of robot time
        """
        time_us = self.length_us + 1 if until_us is None else min(until_us, self.length_us + 1)
        earlier = [step for step in self.past.steps if step.at_us <= time_us]
        steps = takewhile(lambda step: step.at_us <= time_us, chain(entries(self._steps), self._changing))
        return replace(
            self.past,
            steps=tuple(merge(earlier, steps, key=_AT)),
            end_us=self.length_us + 1,
            packages={name: version(name) for name in ("pyfrc", "wpilib")},
            trace=None,
            story=(),
        )

    def digest(self) -> str | None:
        """Return the hash of what the robot did; None when it is not known from the start."""
        if not self._known:
            return None
        digest = hashlib.sha256()
        for change in entries(self.changes):
            digest.update(lines_of(change)[0].encode())
        return digest.hexdigest()

    def until(self, time_us: int) -> Recording:
        """Return a recording of the part until a moment, which can grow from there."""
        past = self.inputs(time_us)
        values = {target: value for step in past.steps for target, value in step.writes.items()}
        if free := released(values):  # the run that goes on from there has no log
            past = replace(past, steps=(*past.steps, Step(min(time_us + 1, past.end_us), free)))
        part = Recording(past, self._known)
        part.length_us = time_us
        part.is_open = self.is_open
        if not self.is_open:
            part.changes = self.changes.until(time_us)
            part.network_changes = self.network_changes.until(time_us)
        part._stations = self._stations.until(time_us)
        return part

    def again(self) -> Recording:
        """Return a recording of the same inputs for a changed robot program, which may do something else."""
        again = Recording(self.inputs(), known=False)
        again.length_us = self.length_us
        again.is_open = True
        again._stations = self._stations.until(self.length_us + 1)
        return again

    @property
    def station(self) -> StationState:
        """The driver station at the end."""
        return self._stations.last or StationState()

    def save(self, file: Path) -> None:
        """Write the input script, and beside it the trace, where it is known."""
        script = self.script()
        script.save(file)
        if script.trace is not None:
            write_whole(trace_beside(file), self._trace(script.trace))

    def _trace(self, digest: str) -> Iterator[str]:
        yield json.dumps({"format": FORMAT}) + "\n"
        for change in entries(self.changes):
            yield lines_of(change)[1] + "\n"
        yield json.dumps({"sha256": digest}) + "\n"
