"""Which match of a campaign is played next, and in which order results are used."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...project import Project
from ..guidance.seed_schedule import SeedSchedule, match_seconds
from ..inputs.match_plan import SHORT_SECONDS
from ..match.work import FuzzTask, MatchResult
from .stream import STREAMS, Stream

#: How many matches of each stream are a batch.
_BATCH = 32 // STREAMS
#: The longest match that is worth its time, as a share of the campaign's.
_LONGEST = 0.125


@dataclass(frozen=True)
class Match:
    """One match.

    :param number: None for a match of an earlier campaign
    """

    stream: Stream
    schedule: SeedSchedule
    number: int | None = None


class _Running(NamedTuple):
    task: FuzzTask
    match: Match
    began: float


class Playing:
    """The matches of a campaign.

    :param runs: how many to play, or None
    :param seconds: how long the campaign is, or None
    :param in_batches: whether results are used in the order of their matches, when a batch is over; else at once
    """

    def __init__(
        self, project: Project, streams: Sequence[Stream], runs: int | None, seconds: float | None, in_batches: bool
    ) -> None:
        self.in_batches = in_batches
        #: The entries of NetworkTables that the program is known to write all the time.
        self.published: frozenset[str] = frozenset()
        #: The lines of code that always set an output while the robot is disabled.
        self.always_set: tuple[str, ...] = ()
        #: Whether no more matches are begun.
        self.over = False
        self._project, self._streams, self._runs, self._seconds = project, streams, runs, seconds
        self._next: deque[Match] = deque()
        #: The matches of this batch, in order, and their results by the identity of the match.
        self._batch: list[Match] = []
        self._results: dict[int, MatchResult] = {}
        self._running: dict[int, _Running] = {}
        self._real_seconds = self._robot_seconds = 0.0

    @property
    def running(self) -> int:
        """Return how many matches are being played."""
        return len(self._running)

    @property
    def is_between_batches(self) -> bool:
        """Return whether all results are used, and the next match begins a batch."""
        return self.in_batches and not self._next and not self._running

    def revisit(self, matches: Sequence[Match]) -> None:
        """Play these first."""
        self._next.extend(matches)
        self._batch.extend(matches)

    def end(self) -> None:
        """Begin no more matches."""
        self.over = True
        self._next.clear()

    def next_task(self) -> FuzzTask | None:
        """Return the next match to play, if one may begin now."""
        while not self._next and not self.over and not (self.in_batches and self._running):
            self._choose()
        if not self._next:
            return None
        match = self._next.popleft()
        task = FuzzTask(match.schedule, match.stream.reached, False, self.published, self.always_set)
        self._running[id(task)] = _Running(task, match, time.monotonic())
        return task

    def finish(self, task: FuzzTask, played: MatchResult) -> Iterator[tuple[Match, MatchResult]]:
        """Note the result of a match; yield the results to use now."""
        _, match, began = self._running.pop(id(task))
        self._real_seconds += time.monotonic() - began
        self._robot_seconds += played.script.end_us / 1_000_000
        if not self.in_batches:
            yield match, played
            return
        self._results[id(match)] = played
        if self.is_between_batches:
            yield from [(each, self._results[id(each)]) for each in self._batch if id(each) in self._results]
            for stream in self._streams:
                stream.skip(sum(each.stream is stream and each.number is not None for each in self._batch))
            self._batch.clear()
            self._results.clear()

    def _choose(self) -> None:
        """Choose the next matches: a batch, or one."""
        chosen = [
            (number, stream)
            for stream in self._streams
            for number in stream.next_numbers(_BATCH if self.in_batches else 1, self._runs)
        ]
        chosen.sort(key=lambda each: each[0])
        if not chosen:
            self.over = True
            return
        matches = [Match(stream, stream.scheduler.schedule(number), number) for number, stream in chosen]
        if not self.in_batches:
            self._streams[0].skip(1)
            if self._takes_too_long(matches[0]):
                return
        self._next.extend(matches)
        if self.in_batches:
            self._batch.extend(matches)

    def _takes_too_long(self, match: Match) -> bool:
        """Return whether a match would take too much of the campaign's time; short ones never do."""
        seconds = match_seconds(self._project, match.schedule)
        if self._seconds is None or not self._robot_seconds or seconds <= SHORT_SECONDS:
            return False
        return seconds * self._real_seconds / self._robot_seconds > _LONGEST * self._seconds
