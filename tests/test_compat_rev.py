"""What pyfrc reaches inside REV's library: when this fails, robots with SPARKs no longer repeat."""

from __future__ import annotations

import sys

import pytest
from skips import require

from pyfrc_core.compat.rev_noise import seed_noise

require("robots with vendors' packages", [] if sys.version_info >= (3, 11) else ["Python 3.11"])


def draws(count: int) -> list[float]:
    import rev

    return [rev.NoiseGenerator.whiteNoise(0.0, 1.0) for _ in range(count)]


@pytest.mark.skipif(sys.platform != "linux", reason="REV's noise: needs Linux")
def test_the_noise_of_simulated_sparks_is_seeded() -> None:
    before = draws(3)
    assert seed_noise(5)
    first = draws(1001)  # an odd number: one is kept for the next draw
    assert seed_noise(5)
    assert draws(1001) == first
    assert seed_noise(6)
    assert draws(1001) != first
    assert before != first[:3]
    # They are still those of a normal distribution.
    mean = sum(first) / len(first)
    assert abs(mean) < 0.2
    assert 0.7 < sum((value - mean) ** 2 for value in first) / len(first) < 1.4
