"""The random seeds of a campaign's matches, derived from its seed, a match's number and the goals reached before."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...project import Project
from ...runtime.clock import PACKET_US, to_us
from ...runtime.scripts.script import InputScript
from ..inputs.left_out import LeftOut, needed_inputs
from ..inputs.match_plan import SHORT, BaseMatch, length_of
from ..oracle.failure import FuzzFailure
from .goals import BRANCH, LINE, STATE, Goal, kind_of
from .known_failures import KnownFailures

#: The share of matches that continue an earlier one, when there are any worth continuing.
_CONTINUED = 0.5
#: The share of new matches that begin with a recorded one, when there are any.
_FROM_RECORDED = 0.8
#: With a limit of time, the first matches are short, and continue none; then every other one is short.
_FIRST_SHORT = 24
#: A match that continues another equals it for at most this long after that one first reached a goal.
_SAME_FOR_US = 1_000_000
#: How many matches worth continuing are remembered for each kind of goal: the latest, which have reached the goals that
#: are hardest to reach.
_MOST_REMEMBERED = 64
#: How many of them a later campaign plays again.
_MOST_KEPT = 24
#: How many seeds the robots' own random generators have.
_ROBOT_SEEDS = 10_000
#: How often each kind of goal is continued from, relative to the others.
_WEIGHTS = {LINE: 4, BRANCH: 3, STATE: 3}


@dataclass(frozen=True)
class SeedSchedule:
    """The random seeds of one match.

    :param seeds: pairs of a time in microseconds and the seed that holds from then on; the first time is 0
    :param left_out: pairs of a time in microseconds and the inputs that the match does without from then on
    :param base: the recorded match with which it begins
    """

    seeds: tuple[tuple[int, str], ...]
    left_out: tuple[tuple[int, LeftOut], ...] = ()
    base: BaseMatch | None = None

    @property
    def robot_seed(self) -> int:
        """Return the seed of the robot's own random generators."""
        return random.Random(f"robot {self.seeds[0][1]}").randrange(_ROBOT_SEEDS)

    def rng(self) -> random.Random:
        """Return the random number generator for the start of the match; `reseed` keeps it up to date."""
        return random.Random(self.seeds[0][1])

    def reseed(self, rng: random.Random, before_us: int, now_us: int) -> None:
        """Reseed the generator when a new seed holds from between these two times.

        A robot with the same inputs behaves in the same way. So a match with the first seeds of another one equals it
        up to the first different seed, and only the seeds need to be stored.
        """
        for at_us, seed in self.seeds[1:]:
            if before_us < at_us <= now_us:
                rng.seed(seed)

    def left_out_at(self, now_us: int) -> LeftOut:
        """Return the inputs that the match does without at this time."""
        return next((left_out for at_us, left_out in reversed(self.left_out) if at_us <= now_us), frozenset())


@dataclass(frozen=True)
class _Worthwhile:
    schedule: SeedSchedule
    reached_us: tuple[int, ...]


class SeedScheduler:
    """Chooses the seeds of a campaign's matches: the same choices for the same seed and the same goals, reported in the
    same order.

    :param recorded: matches to begin with: each is played once as it is, and most others begin with one of them
    :param begins_short: whether the first matches are short
    """

    def __init__(self, seed: int, recorded: Sequence[InputScript] = (), begins_short: bool = False) -> None:
        self._begins_short = begins_short
        self._seed = seed
        self._recorded = recorded
        self._worthwhile: dict[str, list[_Worthwhile]] = {kind: [] for kind in _WEIGHTS}
        self.known = KnownFailures()

    def schedule(self, number: int) -> SeedSchedule:
        """Return the seeds of the match with this number."""
        own = f"fuzz {self._seed} {number}"
        rng = random.Random(f"recipe {own}")
        if number < len(self._recorded):
            whole = BaseMatch(self._recorded[number], self._recorded[number].end_us)
            return SeedSchedule(((0, own),), ((0, frozenset()),), whole)
        left_out = self.known.left_out(random.Random(f"left out {own}"))
        kinds = [kind for kind, worthwhile in self._worthwhile.items() if worthwhile]
        is_first = self._begins_short and number < _FIRST_SHORT
        if is_first or not kinds or rng.random() >= _CONTINUED:
            is_short = is_first or (self._begins_short and number % 2)
            first = own + SHORT if is_short else own
            return SeedSchedule(((0, first),), ((0, left_out),), self._base(own))
        (kind,) = rng.choices(kinds, [_WEIGHTS[kind] for kind in kinds])
        base = rng.choice(self._worthwhile[kind])
        from_us = rng.choice(base.reached_us) + rng.randrange(0, _SAME_FOR_US, PACKET_US)
        before = tuple(turn for turn in base.schedule.seeds if turn[0] < from_us)
        left_out_before = tuple(turn for turn in base.schedule.left_out if turn[0] < from_us)
        seeds, left_outs = (*before, (from_us, own)), (*left_out_before, (from_us, left_out))
        return SeedSchedule(seeds, left_outs, base.schedule.base)

    def _base(self, own: str) -> BaseMatch | None:
        rng = random.Random(f"base {own}")
        if not self._recorded or rng.random() >= _FROM_RECORDED:
            return None
        return BaseMatch.choose(rng.choice(self._recorded), rng)

    def avoid(self, failure: FuzzFailure, script: InputScript) -> None:
        """Leave out what this shortest script of a failure needs in many later matches, if it ends many."""
        self.known.add(failure, needed_inputs(script))

    def state(self) -> dict[str, Any]:
        """Return what `schedules_of` needs, as values of JSON: the latest matches that are worth continuing."""
        schedules = dict.fromkeys(each.schedule for kind in self._worthwhile.values() for each in kind)
        return {
            "worthwhile": [
                [each.seeds, [(at_us, sorted(left_out)) for at_us, left_out in each.left_out]]
                for each in list(schedules)[-_MOST_KEPT:]
            ]
        }

    @staticmethod
    def schedules_of(state: Mapping[str, Any]) -> list[SeedSchedule]:
        """Return the matches in a scheduler's state."""
        return [
            SeedSchedule(
                tuple((int(at_us), str(seed)) for at_us, seed in seeds),
                tuple((int(at_us), frozenset(targets)) for at_us, targets in left_out),
            )
            for seeds, left_out in state["worthwhile"]
        ]

    def learn(self, schedule: SeedSchedule, reached: Mapping[Goal, int]) -> None:
        """Note the goals that a match was the first to reach.

        :param reached: when it reached each goal, in microseconds
        """
        moments: dict[str, set[int]] = {}
        for goal, at_us in reached.items():
            moments.setdefault(kind_of(goal), set()).add(at_us)
        for kind, times in moments.items():
            remembered = [*self._worthwhile[kind], _Worthwhile(schedule, tuple(sorted(times)))]
            self._worthwhile[kind] = remembered[-_MOST_REMEMBERED:]


def match_seconds(project: Project, schedule: SeedSchedule) -> float:
    """Return the length of a match with this schedule, in seconds."""
    if schedule.base is not None:
        return schedule.base.end_us(to_us(project.settings.fuzz.match_seconds)) / 1_000_000
    return length_of(schedule.seeds[0][1], project.settings.fuzz.match_seconds, project.settings.match)
