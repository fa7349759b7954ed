"""Avoid known failures that end many matches: others leave out an input of each, and find what is behind it.

An exception ends a match. A bug that every driver meets in the first seconds would therefore hide all others. The
shortest script of a failure has only inputs that it needs, so a match without one of them does not fail in this way.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

from ..oracle.failure import FuzzFailure

#: The share of matches that leave out something of a failure which ends this share of the other matches, or more. A
#: failure that ends fewer is left out less often.
_AVOIDED, _OFTEN = 0.9, 0.3
#: A failure is frequent if it ends this share of the matches that can meet it, and at least so many.
_FREQUENT, _LEAST_ENDED = 0.25, 3


@dataclass
class _KnownFailure:
    """A failure that ends matches.

    :param needed: the inputs of its shortest script; empty until it is known
    :param met: how many matches could meet it
    :param ended: how many of them it has ended
    """

    failure: FuzzFailure
    needed: tuple[str, ...] = ()
    met: int = 0
    ended: int = 0

    def share_to_avoid(self) -> float:
        return _AVOIDED * min(1.0, self.ended / max(1, self.met) / _OFTEN)


class KnownFailures:
    """The failures that have ended matches, and what they need."""

    def __init__(self) -> None:
        self._matches = 0
        self._known: list[_KnownFailure] = []

    def add(self, failure: FuzzFailure, needed: tuple[str, ...]) -> None:
        """Add the inputs that the shortest script of a failure needs."""
        self._find(failure).needed = needed

    def note(self, left_out: frozenset[str], failure: FuzzFailure | None) -> None:
        """Note how a match has ended.

        :param left_out: what it left out
        :param failure: the failure that ended it, if there was one
        """
        if failure is not None:
            self._find(failure)
        self._matches += 1
        for known in self._known:
            if left_out.isdisjoint(known.needed):
                known.met += 1
                known.ended += known.failure.same_as(failure)

    def frequent(self) -> list[FuzzFailure]:
        """Return the failures that have ended many matches, and of which it is not known what they need."""
        return [
            known.failure
            for known in self._known
            if not known.needed and known.ended >= _LEAST_ENDED and known.ended >= _FREQUENT * known.met
        ]

    def left_out(self, rng: random.Random) -> frozenset[str]:
        """Choose what a match leaves out: an input of each failure that ends many matches."""
        return frozenset(
            rng.choice(known.needed) for known in self._known if known.needed and rng.random() < known.share_to_avoid()
        )

    def _find(self, failure: FuzzFailure) -> _KnownFailure:
        for known in self._known:
            if known.failure.same_as(failure):
                return known
        # All earlier matches could meet it, too.
        self._known.append(_KnownFailure(failure, met=self._matches))
        return self._known[-1]
