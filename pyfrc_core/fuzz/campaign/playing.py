"""Which match of a campaign is played next, and in which order results are used."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from ...processors import usable_processors
from ...project import Project
from ..guidance.goals import Goal
from ..guidance.seed_schedule import SeedSchedule, SeedScheduler, match_seconds
from ..match.work import FuzzTask, MatchResult
from .results import CampaignOptions

#: How many matches are a batch.
_BATCH = 32
#: Of a robot of which a second takes more processor seconds than this, the lines are watched in every so many matches
#: only: before Python 3.12, that takes a quarter of the time.
_COSTLY, _WATCHED_EVERY = 0.3, 4
#: The longest match that is worth its time, as a share of the campaign's; one of the usual length always is.
_LONGEST = 0.125


@dataclass(frozen=True)
class Match:
    """One match.

    :param number: None for a match of an earlier campaign
    """

    schedule: SeedSchedule
    number: int | None = None


class _Running(NamedTuple):
    task: FuzzTask
    match: Match
    began: float


class Playing:
    """The matches of a campaign.

    Which matches are continued depends on what earlier ones have reached. With a number of matches, they are played in
    batches, and the results of a batch are used in the order of their numbers: then the campaign is the same with
    any number of processes. With a limit of time, each result is used at once.
    """

    def __init__(self, project: Project, options: CampaignOptions) -> None:
        self.in_batches = options.runs is not None
        #: What the robot's starts show, for all matches.
        self.known_of_robot = FuzzTask(SeedSchedule(()))
        #: Whether no more matches are begun.
        self.over = False
        self.scheduler = SeedScheduler(options.seed, options.recorded, begins_short=not self.in_batches)
        self.reached: frozenset[Goal] = frozenset()
        #: Processor seconds for a second of robot time; None before the first match.
        self.cost: float | None = None
        self._project, self._options = project, options
        #: How many matches of this machine's part were chosen.
        self._chosen = self._learned = 0
        self._next: deque[Match] = deque()
        #: The matches of this batch, in order, and their results by the identity of the match.
        self._batch: list[Match] = []
        self._results: dict[int, MatchResult] = {}
        self._running: dict[int, _Running] = {}
        self._real_seconds = self._robot_seconds = 0.0
        #: The first match in which each failure has occurred since `frequent_failures` was called.
        self._failed: dict[str, tuple[int | None, MatchResult]] = {}

    @property
    def running(self) -> int:
        """Return how many matches are being played."""
        return len(self._running)

    @property
    def is_between_batches(self) -> bool:
        """Return whether all results are used, and the next match begins a batch."""
        return self.in_batches and not self._next and not self._running

    def kept(self) -> dict[str, Any]:
        """Return what `resume` needs, as values of JSON."""
        return {"played": self._learned, **self.scheduler.state()}

    def resume(self, kept: Mapping[str, Any]) -> None:
        """Go on where an earlier campaign ended: first, play its matches again that were worth continuing."""
        try:
            self._chosen = self._learned = int(kept["played"])
            matches = [Match(schedule) for schedule in SeedScheduler.schedules_of(kept)]
        except (KeyError, TypeError, ValueError):  # there is none, or of another version
            self._chosen = self._learned = 0
            return
        self._next.extend(matches)
        self._batch.extend(matches)

    def next_task(self) -> FuzzTask | None:
        """Return the next match to play, if one may begin now."""
        while not self._next and not self.over and not (self.in_batches and self._running):
            self._choose()
        if not self._next:
            return None
        match = self._next.popleft()
        watches_lines = self._watches_lines(match)
        task = replace(self.known_of_robot, schedule=match.schedule, known=self.reached, watches_lines=watches_lines)
        self._running[id(task)] = _Running(task, match, time.monotonic())
        return task

    def _watches_lines(self, match: Match) -> bool:
        is_costly = not self.in_batches and self.cost is not None and self.cost > _COSTLY
        return sys.version_info >= (3, 12) or not is_costly or (match.number or 0) % _WATCHED_EVERY == 0

    def finish(self, task: FuzzTask, played: MatchResult) -> Iterator[tuple[Match, MatchResult]]:
        """Note the result of a match; yield the results to use now."""
        running = len(self._running)
        _, match, began = self._running.pop(id(task))
        # More processes than processors share these.
        self._real_seconds += (time.monotonic() - began) * min(1.0, usable_processors() / running)
        self._robot_seconds += played.script.end_us / 1_000_000
        if self._robot_seconds:
            self.cost = self._real_seconds / self._robot_seconds
        if not self.in_batches:
            yield match, self._learn(match, played)
            return
        self._results[id(match)] = played
        if self.is_between_batches:
            for each in self._batch:
                yield each, self._learn(each, self._results[id(each)])
            self._batch.clear()
            self._results.clear()

    def _learn(self, match: Match, played: MatchResult) -> MatchResult:
        """Note the goals that a match has reached, and how it ended."""
        new = {goal: at_us for goal, at_us in played.reached.items() if goal not in self.reached}
        self.scheduler.learn(match.schedule, new)
        self.scheduler.known.note(match.schedule.left_out[-1][1], played.failure)
        if played.failure is not None:
            self._failed.setdefault(played.failure.cause, (match.number, replace(played, noted=())))
        self.reached = self.reached.union(new)
        self._learned += match.number is not None
        return played

    def frequent_failures(self) -> list[tuple[int | None, MatchResult]]:
        """Return failures that have ended many matches and that matches do not avoid yet.

        Each has the number of its match.
        """
        failed = self._failed
        return [failed[each.cause] for each in self.scheduler.known.frequent() if each.cause in failed]

    def _choose(self) -> None:
        """Choose the next matches: a batch, or one."""
        shard, end = self._options.shard, self._options.runs
        first = shard.number - 1 + shard.count * self._chosen
        size = max(1, _BATCH // shard.count) if self.in_batches else 1
        numbers = [first + shard.count * each for each in range(size)]
        numbers = [number for number in numbers if end is None or number < end]
        matches = [Match(self.scheduler.schedule(number), number) for number in numbers]
        self._chosen += len(matches)
        if not matches:
            self.over = True
        elif self.in_batches or not self._takes_too_long(matches[0]):
            self._next.extend(matches)
            self._batch.extend(matches)

    def _takes_too_long(self, match: Match) -> bool:
        """Return whether a match that is longer than usual would take too much of the campaign's time."""
        seconds, most = match_seconds(self._project, match.schedule), self._options.seconds
        if most is None or self.cost is None or seconds <= self._project.settings.fuzz.match_seconds:
            return False
        return seconds * self.cost > _LONGEST * most
