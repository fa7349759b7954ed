"""Streams: parts of a campaign that do not depend on each other.

Which matches are continued depends on what earlier matches have reached. Matches of one stream depend on earlier ones
of the same stream only. So several machines that play different streams find together what one machine finds that plays
all of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...runtime.scripts.script import InputScript
from ..guidance.goals import Goal
from ..guidance.seed_schedule import SeedSchedule, SeedScheduler
from ..match.work import MatchResult

#: The number of streams in a campaign that can be divided between machines.
STREAMS = 8


@dataclass(frozen=True)
class Shard:
    """The part of a campaign that one machine plays.

    :param number: from 1 to `count`
    :param count: the number of machines, at most `STREAMS`
    """

    number: int = 1
    count: int = 1

    def plays(self, stream: int) -> bool:
        """Return whether this machine plays the stream with this index."""
        return stream % self.count == self.number - 1


#: One machine plays everything.
ALL = Shard()


class Stream:
    """One part of a campaign.

    :param seed: the campaign's seed
    :param index: its index, from 0
    :param count: the number of streams; this one has the matches ``index``, ``index + count``, ...
    :param recorded: recorded matches to begin with
    """

    def __init__(self, seed: int, index: int, count: int, recorded: Sequence[InputScript] = ()) -> None:
        self._recorded = recorded
        self._seed = seed
        self._index = index
        self._count = count
        self.scheduler = SeedScheduler(seed, recorded, begins_short=count == 1)
        self._played = 0
        #: The first match in which each failure has occurred since `frequent_failures` was called.
        self._failed: dict[str, tuple[int | None, MatchResult]] = {}
        self.reached: frozenset[Goal] = frozenset()

    def next_numbers(self, size: int, end: int | None) -> list[int]:
        """Return the numbers of the next matches, at most `size`, all less than `end`."""
        numbers = (self._index + self._count * each for each in range(self._played, self._played + size))
        return [number for number in numbers if end is None or number < end]

    def skip(self, count: int) -> None:
        """Note that this many of the next matches were played."""
        self._played += count

    def learn(self, schedule: SeedSchedule, number: int | None, played: MatchResult) -> None:
        """Note the goals that a match has reached, and how it ended.

        :param number: None for a match of an earlier campaign
        """
        new = {goal: at_us for goal, at_us in played.reached.items() if goal not in self.reached}
        self.scheduler.learn(schedule, new)
        self.scheduler.note_end(schedule, played.failure)
        if played.failure is not None:
            self._failed.setdefault(played.failure.cause, (number, replace(played, noted=())))
        self.reached = self.reached.union(new)

    def frequent_failures(self) -> list[tuple[int | None, MatchResult]]:
        """Return failures since the last call that have ended many matches and that matches do not avoid yet.

        Each has the number of its match.
        """
        failed, self._failed = self._failed, {}
        return [failed[each.cause] for each in self.scheduler.frequent_failures() if each.cause in failed]

    def ask_again(self, number: int | None, played: MatchResult) -> None:
        """Have `frequent_failures` return this one again."""
        assert played.failure is not None
        self._failed.setdefault(played.failure.cause, (number, played))

    def clear(self) -> None:
        """Begin again."""
        self._played = 0
        self.forget()

    def forget(self) -> None:
        """Forget which goals were reached: the robot's code has changed."""
        self.reached = frozenset()
        self.scheduler = SeedScheduler(self._seed, self._recorded, begins_short=self._count == 1)

    def state(self) -> dict[str, Any]:
        """Return what `restore` needs, as values of JSON."""
        reached = sorted(map(list, self.reached), key=repr)
        return {"played": self._played, "reached": reached, **self.scheduler.state()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Go on where an earlier campaign ended."""
        self._played = int(state["played"])
        self.reached = frozenset(map(tuple, state["reached"]))
        self.scheduler.restore(state)
