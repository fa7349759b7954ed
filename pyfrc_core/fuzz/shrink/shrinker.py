"""Find the shortest script of a failure: few writes, early and with simple values, by running shorter scripts.

First, short scripts are tried that begin with the state in which the robot's inputs were soon before the failure
(`starts`): most bugs need no more, and short runs take little time. The algorithm is then delta debugging
(A. Zeller and R. Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", IEEE Transactions on Software
Engineering 28(2), 2002), also of neighboring writes to one input together, such as a press and its release. Then the
gaps between the remaining writes and their values are reduced.

hypothesis' shrinker does not fit. It shortens the sequence of choices that a generator drew, and runs the generator
again on the rest. Here the generator reads the robot's state while it draws, so each of a thousand writes depends on
those before it: without one choice, all that follows is a different match. Besides, robots run in separate processes,
several at a time, while hypothesis calls a function; and a recorded script has no choices at all.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from itertools import groupby
from typing import Any

from ...runtime.clock import PACKET_US
from ...runtime.scripts.script import InputScript, Step
from ...runtime.scripts.targets import MODE
from ..inputs.values import Input, simpler
from ..match.work import MOST_RUNS, MatchExecutor, ReplayTask
from ..oracle.failure import HANGS, PROCESS_ENDED, FuzzFailure
from .starts import (
    Candidate,
    ScriptWrite,
    moments_held_in_autonomous,
    starts_of,
    transitions_without_pause,
    without_idle_releases,
    without_overwritten,
)

#: The maximum number of runs for a robot that hangs, since each takes `hang_seconds`.
_MOST_HANGING_RUNS = 100
#: Processor seconds without progress that count as a hang while a script of a hang is shortened. The shortest script is
#: run once more with the project's own `hang_seconds`.
_SHORT_HANG_SECONDS = 0.3
#: How many neighboring writes to one input are removed together: a press and its release; two of them, since removing
#: one of them inverts what a button toggles.
_NEIGHBORS = (2, 4)

#: Gaps to try between two moments, in packets.
_GAPS = (0, 1, 2, 5, 10, 25, 50, 100, 250, 500)


class Shrinker:
    """Shortens one script for as long as it fails in the same way.

    :param executor: runs the shorter scripts
    :param script: a script that has failed
    :param failure: the failure
    :param inputs: the kinds of its targets' values, as far as they are known
    :param most_runs: the maximum number of runs
    :param use_oracle: whether misbehavior without an exception is a failure
    :param seconds: after this time in real time, no more runs begin; None: without a limit
    """

    def __init__(
        self,
        executor: MatchExecutor,
        script: InputScript,
        failure: FuzzFailure,
        inputs: Mapping[str, Input],
        most_runs: int = MOST_RUNS,
        use_oracle: bool = True,
        seconds: float | None = None,
    ) -> None:
        self.failure = failure
        self.runs = 0
        #: Whether the shortest script so far has failed when it was run.
        self.repeats = False
        self._use_oracle = use_oracle
        self._until = math.inf if seconds is None else time.monotonic() + seconds
        self._executor = executor
        self._inputs = inputs
        self._most_runs = min(most_runs, _MOST_HANGING_RUNS) if failure.kind == HANGS else most_runs
        self._hang_seconds: float | None = None
        if failure.kind == HANGS:
            self._hang_seconds = min(_SHORT_HANG_SECONDS, executor.project.settings.fuzz.hang_seconds)
        self._header = replace(script, steps=())
        self._whole = Candidate(tuple(_writes(script)), script.end_us)
        self._writes, self._end_us = self._whole
        self._without_pause = transitions_without_pause(self._writes)
        self._held_in_autonomous = moments_held_in_autonomous(self._writes)
        self._tried: set[Candidate] = set()

    @property
    def script(self) -> InputScript:
        """Return the shortest script so far."""
        return self._script(self._writes, self._end_us)

    @property
    def _is_over(self) -> bool:
        return self.runs >= self._most_runs or time.monotonic() >= self._until

    def shrink(self) -> None:
        """Run shorter scripts until nothing can be removed, or a limit is reached."""
        self._shrink()
        if self._hang_seconds is not None and self.repeats and not self.play_again():
            # What takes long is not what hangs: start again, with the limit that the project has.
            self._hang_seconds = None
            self.repeats = False
            self._tried.clear()
            self._writes, self._end_us = self._whole
            self._shrink()

    def play_again(self) -> bool:
        """Run the shortest script once more, as a replay does; return whether it fails in the same way."""
        (played,) = self._executor.play([ReplayTask(self.script, self._use_oracle, self.failure, paced=True)])
        return self.failure.same_as(played.failure)

    def _shrink(self) -> None:
        # The moment of an ended process is not known.
        starts = starts_of(*self._whole) if self.failure.kind != PROCESS_ENDED else []
        if self._first_of([*starts, self._whole]) is None:
            return
        self._first([without_idle_releases(self._writes)])
        self._fewer(self._by(_sort_of))
        self._fewer(self._by(lambda target: target))
        before: InputScript | None = None
        while self.script != before and not self._is_over:
            before = self.script
            self._fewer([(write,) for write in self._writes])
            for count in _NEIGHBORS:
                self._without_neighbors(count)
            self._sooner()
            self._simpler()
        if self.failure.kind in (HANGS, PROCESS_ENDED):
            self._shorter()

    # -- trying ----------------------------------------------------------------------------------------------------

    def _first(self, candidates: Iterable[tuple[ScriptWrite, ...]]) -> int | None:
        """Take the first candidate that fails in the same way; return its index, or None."""
        return self._first_of(Candidate(writes, self._end_us) for writes in candidates)

    def _first_of(self, candidates: Iterable[Candidate]) -> int | None:
        """As `_first`, with candidates that have their own ends.

        Several run at the same time; they count as if they ran one after the other.
        """
        left = self._most_runs - self.runs
        new: list[tuple[int, Candidate]] = []
        for index, candidate in enumerate(candidates):
            if candidate not in self._tried and len(new) < left and self._is_playable(candidate.writes):
                self._tried.add(candidate)
                new.append((index, candidate))
        tasks = (self._follow(*candidate) for _, candidate in new)
        with closing(self._executor.play(tasks)) as results:
            for (index, candidate), played in zip(new, results, strict=True):
                self.runs += 1
                if played.failure is not None and self.failure.same_as(played.failure):
                    self.failure = played.failure
                    self.repeats = True
                    self._end_us = played.script.end_us
                    self._writes = tuple(write for write in candidate.writes if write.at_us < self._end_us)
                    # Later candidates do not count as tried; another pass may try them.
                    self._tried.difference_update(each for at, each in new if at > index)
                    return index
                if self._is_over:
                    return None
        return None

    def _is_playable(self, writes: Sequence[ScriptWrite]) -> bool:
        """Return whether a field can play this as well as the whole script: it disables robots between two modes, and
        sends no joystick data in autonomous.
        """
        return (
            transitions_without_pause(writes) <= self._without_pause
            and moments_held_in_autonomous(writes) <= self._held_in_autonomous
        )

    def _follow(self, writes: Sequence[ScriptWrite], end_us: int) -> ReplayTask:
        return ReplayTask(self._script(writes, end_us), self._use_oracle, self.failure, self._hang_seconds)

    def _script(self, writes: Sequence[ScriptWrite], end_us: int) -> InputScript:
        steps = tuple(
            Step(at_us, {write.target: write.value for write in together})
            for at_us, together in groupby(writes, key=lambda write: write.at_us)
        )
        return replace(self._header, steps=steps, end_us=end_us)

    # -- fewer -------------------------------------------------------------------------------------------------

    def _fewer(self, units: list[tuple[ScriptWrite, ...]]) -> None:
        """Remove as many of these units as possible: ddmin, by complements."""
        parts = min(2, len(units))
        while units and not self._is_over:
            chunks = [units[len(units) * part // parts : len(units) * (part + 1) // parts] for part in range(parts)]
            found = self._first(self._without(chunk) for chunk in chunks)
            if found is not None:
                left = {write.number for write in self._writes}
                units = [
                    unit
                    for chunk in (*chunks[:found], *chunks[found + 1 :])
                    for unit in chunk
                    if any(write.number in left for write in unit)
                ]
                parts = min(max(parts - 1, 2), len(units))
            elif parts >= len(units):
                return
            else:
                parts = min(2 * parts, len(units))

    def _by(self, key: Callable[[str], str]) -> list[tuple[ScriptWrite, ...]]:
        """Return the writes by a part of their targets, in order: what is similar is removed together."""
        groups: dict[str, list[ScriptWrite]] = {}
        for write in sorted(self._writes, key=lambda write: (write.target, write.at_us, write.number)):
            groups.setdefault(key(write.target), []).append(write)
        return [tuple(writes) for writes in groups.values()]

    def _without_neighbors(self, count: int) -> None:
        """Remove this many neighboring writes to one input together, wherever possible."""
        found: int | None = 0
        while found is not None and not self._is_over:
            candidates = [
                self._without([unit[first : first + count]])
                for unit in self._by(lambda target: target)
                for first in range(len(unit) - count + 1)
            ]
            found = self._first(candidates)

    def _without(self, units: Iterable[tuple[ScriptWrite, ...]]) -> tuple[ScriptWrite, ...]:
        gone = {write.number for unit in units for write in unit}
        return tuple(write for write in self._writes if write.number not in gone)

    # -- sooner ------------------------------------------------------------------------------------------------

    def _sooner(self) -> None:
        """Make each gap between two moments as short as possible."""
        index = 0
        while index < len(moments := sorted({write.at_us for write in self._writes})):
            start_us = moments[index - 1] if index else 0
            gap = (moments[index] - start_us) // PACKET_US
            shorter = [packets for packets in _GAPS if packets < gap]
            found = self._first(self._moved(moments[index], packets - gap) for packets in shorter)
            high = gap if found is None else shorter[found]
            low = shorter[-1] if found is None and shorter else shorter[found - 1] if found else -1
            while high - low > 1 and low >= 0 and not self._is_over:
                middle = (low + high) // 2
                from_us = start_us + high * PACKET_US
                if self._first([self._moved(from_us, middle - high)]) is None:
                    low = middle
                else:
                    high = middle
            # When writes have joined the previous moment, the next moment has this index.
            index += 1 if high > 0 or gap == 0 or not index else 0

    def _moved(self, from_us: int, packets: int) -> tuple[ScriptWrite, ...]:
        return without_overwritten(
            [
                replace(write, at_us=write.at_us + packets * PACKET_US) if write.at_us >= from_us else write
                for write in self._writes
            ]
        )

    def _shorter(self) -> None:
        """End the script soon after its last write: a process that died did not report its time."""
        last_us = self._writes[-1].at_us if self._writes else 0
        for packets in _GAPS[1:]:
            end_us = last_us + packets * PACKET_US
            if end_us >= self._end_us or self._is_over:
                return
            self.runs += 1
            (played,) = self._executor.play([self._follow(self._writes, end_us)])
            if self.failure.same_as(played.failure):
                self._end_us = end_us
                return

    # -- simpler -----------------------------------------------------------------------------------------------

    def _simpler(self) -> None:
        for number in [write.number for write in self._writes]:
            write = next((write for write in self._writes if write.number == number), None)
            if write is not None:
                self._first(self._with_value(number, value) for value in self._values(write))

    def _values(self, write: ScriptWrite) -> Iterator[Any]:
        if write.target == MODE and str(write.value).startswith("disabled "):
            yield "disabled"
        each = self._inputs.get(write.target)
        if each is not None:
            yield from simpler(each.kind, write.value)

    def _with_value(self, number: int, value: object) -> tuple[ScriptWrite, ...]:
        return tuple(replace(write, value=value) if write.number == number else write for write in self._writes)


def _sort_of(target: str) -> str:
    """Return the sort of an input: ``joysticks``, ``CAN``, ``nt``, ``dio``."""
    return re.split(r"\W", target, maxsplit=1)[0]


def _writes(script: InputScript) -> Iterator[ScriptWrite]:
    number = 0
    for step in script.steps:
        for target, value in step.writes.items():
            yield ScriptWrite(step.at_us, target, value, number)
            number += 1
