"""What a campaign's matches are made of: the seed, their number, and the lines that those before have reached."""

from __future__ import annotations

import random
from dataclasses import dataclass

from ..runtime.clock import PACKET_US
from .lines import Line

#: How many matches go on from one that has been, when there are any worth it.
_CONTINUED = 0.5
#: How long after a line was first reached a match still goes the same way, at most.
_GOES_ON_US = 1_000_000
#: So many matches worth going on from are kept: the latest, which have reached what is hardest to reach.
_MOST_KEPT = 64


@dataclass(frozen=True)
class SeedSchedule:
    """How to mash one match.

    :param turns: where its chance comes from: by the microsecond from which that holds, the first at 0
    """

    seeds: tuple[tuple[int, str], ...]

    def rng(self) -> random.Random:
        """The generator at the beginning; see `turn`."""
        return random.Random(self.seeds[0][1])

    def reseed(self, rng: random.Random, before_us: int, now_us: int) -> None:
        """Begin anew what is to begin anew now.

        The robot, told the same, does the same: so a match goes as another did until then, without anything being kept
        of that but where its chance came from.
        """
        for at_us, seed in self.seeds[1:]:
            if before_us < at_us <= now_us:
                rng.seed(seed)


@dataclass(frozen=True)
class _Worthwhile:
    schedule: SeedSchedule
    reached_us: tuple[int, ...]


class SeedScheduler:
    """The schedules of one campaign: the same for the same seed and the same lines, told in the same order."""

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._worthwhile: list[_Worthwhile] = []

    def schedule(self, number: int) -> SeedSchedule:
        """How to mash the match of this number."""
        own = f"fuzz {self._seed} {number}"
        rng = random.Random(f"recipe {own}")
        if not self._worthwhile or rng.random() >= _CONTINUED:
            return SeedSchedule(((0, own),))
        base = rng.choice(self._worthwhile)
        from_us = rng.choice(base.reached_us) + rng.randrange(0, _GOES_ON_US, PACKET_US)
        before = tuple(turn for turn in base.schedule.seeds if turn[0] < from_us)
        return SeedSchedule((*before, (from_us, own)))

    def learn(self, schedule: SeedSchedule, reached: dict[Line, int]) -> None:
        """A match has been the first to reach these lines.

        :param reached: when it reached each, in microseconds
        """
        if reached:
            moments = tuple(sorted(set(reached.values())))
            self._worthwhile = [*self._worthwhile, _Worthwhile(schedule, moments)][-_MOST_KEPT:]
