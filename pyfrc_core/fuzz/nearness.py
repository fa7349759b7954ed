"""Measure how near comparisons of numbers come to another result: a match that comes nearer is worth continuing."""

from __future__ import annotations

import math
from collections.abc import Callable

from .goals import BRANCH, NEAR, Goal

#: Whole numbers that are this near have a level for each difference: robots count to 3 or 5.
_COUNTED = 16
#: Differences of other numbers have a level for each halving, between these powers of two.
_WIDEST, _CLOSEST = 20, -6


def _level(difference: float, whole: bool) -> int:
    """Return a number that is greater for smaller differences."""
    if whole and difference <= _COUNTED:
        return _WIDEST - int(difference)
    power = math.frexp(difference)[1] if difference else _CLOSEST
    return -min(_WIDEST, max(_CLOSEST, power))


class _Comparison:
    """The key of a comparison's probe.

    :param goal: its goal without a level
    """

    def __init__(self, goal: Goal) -> None:
        self.goal = goal
        self.begin(None, lambda: 0)

    def begin(self, known: int | None, now_us: Callable[[], int]) -> None:
        """Forget the last match; `known` is the highest level that is known, or None."""
        self.level = known
        self.least = math.inf
        self.reached_us: int | None = None
        self._now_us = now_us

    def __getitem__(self, pair: tuple[object, object]) -> None:
        left, right = pair
        # Exact types: other types may define their own subtraction, and `bool` has no nearness.
        kinds = type(left), type(right)
        if kinds == (float, float) or kinds == (int, int) or kinds == (float, int) or kinds == (int, float):
            try:
                difference = abs(left - right)  # type: ignore[operator]
            except OverflowError:
                return
            if difference < self.least:
                self.least = difference
                level = _level(difference, kinds == (int, int))
                if self.level is None or level > self.level:
                    self.level, self.reached_us = level, self._now_us()


class Nearness:
    """All comparisons that are measured."""

    def __init__(self) -> None:
        self._comparisons: dict[Goal, _Comparison] = {}

    def comparison(self, goal: Goal) -> _Comparison:
        """Return the key of the comparison with this goal, which has no level."""
        return self._comparisons.setdefault(goal, _Comparison(goal))

    def begin(self, known: frozenset[Goal], now_us: Callable[[], int]) -> None:
        """Begin a match."""
        levels: dict[Goal, int] = {}
        for goal in known:
            if goal[0] == NEAR:
                levels[goal[:-1]] = max(levels.get(goal[:-1], -1000), int(goal[-1]))
        for goal, comparison in self._comparisons.items():
            comparison.begin(levels.get(goal), now_us)

    def reached(self, known: frozenset[Goal]) -> dict[Goal, int]:
        """Return the highest level of each comparison that came nearer than known, and when.

        Only a comparison with one known result can come nearer to the other one.
        """
        return {
            (*goal, comparison.level): comparison.reached_us
            for goal, comparison in self._comparisons.items()
            if comparison.reached_us is not None and comparison.level is not None
            if len(known.intersection({(BRANCH, *goal[1:], way) for way in (0, 1)})) == 1
        }
