"""The shortest way to a failure: the fewest writes, as early and as plain as can be, found by playing shorter scripts.

By delta debugging (A. Zeller and R. Hildebrandt, "Simplifying and Isolating Failure-Inducing Input", IEEE Transactions
on Software Engineering 28(2), 2002), and then the gaps between what is left, and its values. Not by hypothesis'
shrinker: that makes shorter the sequence of choices which a generator drew, and runs the generator again on what is
left. Here the generator looks at the robot while it draws, and each of a thousand writes depends on those before: one
choice less makes all that follows another match. And the robots run in processes of their own, several at a time, where
hypothesis calls a function; a recorded script would have no choices to shrink at all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

from ..runtime.clock import PACKET_US
from ..runtime.scripts.script import InputScript, Step
from ..runtime.scripts.targets import MODE
from .failure import HANGS, PROCESS_ENDED, FuzzFailure
from .inputs import Input
from .match import ReplayTask
from .match_executor import MatchExecutor
from .values import simpler

#: How many robots are run at most.
MOST_RUNS = 2_000
#: Of one that hangs, since each run of it takes `hang_seconds`.
_MOST_HANGING_RUNS = 100

#: Gaps between two moments that are tried, in packets.
_GAPS = (0, 1, 2, 5, 10, 25, 50, 100, 250, 500)


@dataclass(frozen=True)
class _Write:
    at_us: int
    target: str
    value: Any
    #: Tells it from all others of the script, whatever becomes of its time and value.
    number: int


class Shrinker:
    """Makes one script shorter, for as long as it fails in the same way.

    :param script: one that has failed
    :param inputs: what sort of values its targets have, as far as that is known
    :param most_runs: how many robots to run
    :param use_oracle: whether more than exceptions is a failure
    :param tell: called with how many that were, as it goes
    """

    def __init__(
        self,
        executor: MatchExecutor,
        script: InputScript,
        failure: FuzzFailure,
        inputs: Mapping[str, Input],
        most_runs: int = MOST_RUNS,
        use_oracle: bool = True,
        tell: Callable[[int], None] = lambda runs: None,
    ) -> None:
        self.failure = failure
        self.runs = 0
        #: Whether what is the shortest so far has failed when it was played.
        self.repeats = False
        self._use_oracle = use_oracle
        self._tell = tell
        self._executor = executor
        self._inputs = inputs
        self._most_runs = min(most_runs, _MOST_HANGING_RUNS) if failure.kind == HANGS else most_runs
        self._header = replace(script, steps=())
        self._writes = tuple(_writes(script))
        self._end_us = script.end_us
        self._tried: set[tuple[_Write, ...]] = set()

    @property
    def script(self) -> InputScript:
        """The shortest so far."""
        return self._script(self._writes, self._end_us)

    def shrink(self) -> None:
        """Play shorter scripts until there is nothing to leave out, or there were too many."""
        if self._first([self._writes]) is None:
            return
        by_target: dict[str, list[_Write]] = {}
        for write in self._writes:
            by_target.setdefault(write.target, []).append(write)
        self._fewer([tuple(writes) for writes in by_target.values()])
        before: InputScript | None = None
        while self.script != before and self.runs < self._most_runs:
            before = self.script
            self._fewer([(write,) for write in self._writes])
            self._sooner()
            self._simpler()
        if self.failure.kind in (HANGS, PROCESS_ENDED):
            self._shorter()

    def play_again(self) -> bool:
        """Whether the shortest fails as it should, once more."""
        (played,) = self._executor.play([self._follow(self._writes, self._end_us)])
        return self.failure.same_as(played.failure)

    # -- trying ----------------------------------------------------------------------------------------------------

    def _first(self, candidates: Iterable[tuple[_Write, ...]]) -> int | None:
        """Take the first of these that fails in the same way; answers which that was, if any did.

        Several are played at a time; they count as if they were played one after the other.
        """
        left = self._most_runs - self.runs
        new: list[tuple[int, tuple[_Write, ...]]] = []
        for index, writes in enumerate(candidates):
            if writes not in self._tried and len(new) < left:
                self._tried.add(writes)
                new.append((index, writes))
        tasks = (self._follow(writes, self._end_us) for _, writes in new)
        with closing(self._executor.play(tasks)) as results:
            for (index, writes), played in zip(new, results, strict=True):
                self.runs += 1
                self._tell(self.runs)
                if played.failure is not None and self.failure.same_as(played.failure):
                    self.failure = played.failure
                    self.repeats = True
                    self._end_us = played.script.end_us
                    self._writes = tuple(write for write in writes if write.at_us < self._end_us)
                    # Those after it do not count as played; a later pass may come to them.
                    self._tried.difference_update(each for at, each in new if at > index)
                    return index
        return None

    def _follow(self, writes: Sequence[_Write], end_us: int) -> ReplayTask:
        return ReplayTask(self._script(writes, end_us), self._use_oracle)

    def _script(self, writes: Sequence[_Write], end_us: int) -> InputScript:
        steps = tuple(
            Step(at_us, {write.target: write.value for write in together})
            for at_us, together in groupby(writes, key=lambda write: write.at_us)
        )
        return replace(self._header, steps=steps, end_us=end_us)

    # -- fewer -------------------------------------------------------------------------------------------------

    def _fewer(self, units: list[tuple[_Write, ...]]) -> None:
        """Leave out as many of these as can be: ddmin, by complements."""
        parts = min(2, len(units))
        while units and self.runs < self._most_runs:
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

    def _without(self, units: Iterable[tuple[_Write, ...]]) -> tuple[_Write, ...]:
        gone = {write.number for unit in units for write in unit}
        return tuple(write for write in self._writes if write.number not in gone)

    # -- sooner ------------------------------------------------------------------------------------------------

    def _sooner(self) -> None:
        """Make each gap between two moments as short as can be."""
        index = 0
        while index < len(moments := sorted({write.at_us for write in self._writes})):
            start_us = moments[index - 1] if index else 0
            gap = (moments[index] - start_us) // PACKET_US
            shorter = [packets for packets in _GAPS if packets < gap]
            found = self._first(self._moved(moments[index], packets - gap) for packets in shorter)
            high = gap if found is None else shorter[found]
            low = shorter[-1] if found is None and shorter else shorter[found - 1] if found else -1
            while high - low > 1 and low >= 0 and self.runs < self._most_runs:
                middle = (low + high) // 2
                from_us = start_us + high * PACKET_US
                if self._first([self._moved(from_us, middle - high)]) is None:
                    low = middle
                else:
                    high = middle
            # What has moved to the moment before it leaves this place to the next one.
            index += 1 if high > 0 or not index else 0

    def _moved(self, from_us: int, packets: int) -> tuple[_Write, ...]:
        return tuple(
            replace(write, at_us=write.at_us + packets * PACKET_US) if write.at_us >= from_us else write
            for write in self._writes
        )

    def _shorter(self) -> None:
        """End it soon after what comes last: a process that has ended did not say when."""
        last_us = self._writes[-1].at_us if self._writes else 0
        for packets in _GAPS[1:]:
            end_us = last_us + packets * PACKET_US
            if end_us >= self._end_us or self.runs >= self._most_runs:
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

    def _values(self, write: _Write) -> Iterator[Any]:
        if write.target == MODE and str(write.value).startswith("disabled "):
            yield "disabled"
        each = self._inputs.get(write.target)
        if each is not None:
            yield from simpler(each.kind, write.value)

    def _with_value(self, number: int, value: Any) -> tuple[_Write, ...]:
        return tuple(replace(write, value=value) if write.number == number else write for write in self._writes)


def _writes(script: InputScript) -> Iterator[_Write]:
    number = 0
    for step in script.steps:
        for target, value in step.writes.items():
            yield _Write(step.at_us, target, value, number)
            number += 1
