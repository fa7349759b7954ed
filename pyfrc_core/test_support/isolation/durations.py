"""How long each test took when it last ran, so that the longest can start first."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping, Sequence

import pytest

_KEY = "pyfrc/durations"
_TYPICAL_SECONDS = 0.3


class Durations:
    """The seconds that tests took, kept in pytest's cache. Without that (``-p no:cacheprovider``), none are known."""

    def __init__(self, config: pytest.Config) -> None:
        self._cache: pytest.Cache | None = getattr(config, "cache", None)
        kept = self._cache.get(_KEY, {}) if self._cache is not None else {}
        self.known: dict[str, float] = dict(kept) if isinstance(kept, dict) else {}
        self._measured: dict[str, float] = {}

    def add(self, report: pytest.TestReport) -> None:
        """Add the duration of a test's setup, call or teardown."""
        self._measured[report.nodeid] = self._measured.get(report.nodeid, 0.0) + report.duration

    def total(self, tests: Iterable[str]) -> float:
        """Return how many seconds tests have to do, as far as that is known."""
        return sum(_number(self.known.get(test), unknown=_TYPICAL_SECONDS) for test in tests)

    def save(self) -> None:
        """Keep what was measured, and of tests that did not run what was known."""
        if self._cache is None or not self._measured:
            return
        with warnings.catch_warnings():
            # Where nothing can be written, pytest's own cache warns of it, in the summary.
            warnings.simplefilter("ignore", pytest.PytestCacheWarning)
            self._cache.set(_KEY, {**self.known, **{test: round(each, 3) for test, each in self._measured.items()}})


def longest_first(tests: Sequence[str], durations: Mapping[str, float]) -> list[int]:
    """Return the order in which to start tests: the longest first, and before these those of unknown duration.

    :param tests: the tests' ids
    :param durations: seconds, by id
    :return: indices of `tests`
    """
    seconds = [_number(durations.get(test)) for test in tests]
    return sorted(range(len(tests)), key=lambda index: -seconds[index])


def _number(duration: object, unknown: float = math.inf) -> float:
    return float(duration) if isinstance(duration, int | float) else unknown
