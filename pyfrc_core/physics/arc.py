"""The path of a robot whose sides approach their steady speeds, accurate to a ten-millionth of its length.

Within a step, each side's speed is ``steady + lag * exp(-t / tau)`` exactly, and the heading follows from the distances
of both sides. The remaining integral, that of the velocity in the direction of the heading, has no closed form.

In a step with little variation, such as 20 ms, both sides nearly keep their speeds, and the path is nearly the chord of
a circle. How far a side is ahead of its position at mean speed rises and falls during the step like a bow: about ``6 p
(1 - p)`` times its mean, with p from 0 to 1. `TankModel` adds the effect of the bows to the chord, as a series that
begins with their means (`bow`); the series is written out there, since it takes most of the time of a simulated drive.

In any other step, Gauss-Legendre quadrature (Abramowitz and Stegun, 25.4.30) is used: the integrand is smooth.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

#: The series is used for steps that turn by less than this, in radians; in which the heading is ahead of a circle's by
#: less than this, on average; and that last at most this many time constants. Within these limits, its error is at most
#: 1.2e-7 of the path: the worst of 126,000 random drivetrains and steps, compared with the quadrature.
MOST_TURN, MOST_BEND, MOST_TIME_CONSTANTS = 0.4, 0.0055, 0.25

#: Positions in a panel of length 1, and weights: from the roots of the Legendre polynomial of degree 8.
_EIGHT = (
    (0.1834346424956498, 0.3626837833783620),
    (0.5255324099163290, 0.3137066458778873),
    (0.7966664774136267, 0.2223810344533745),
    (0.9602898564975363, 0.1012285362903763),
)
EIGHT_NODES = tuple((0.5 + side * root / 2, weight / 2) for root, weight in _EIGHT for side in (-1, 1))

#: The variation (radians turned, plus time constants passed) for which eight nodes are enough.
EIGHT_NODES_SPAN = 3.0


class SideMotion(NamedTuple):
    """The motion of one side of the robot in a step: ``steady + lag * exp(-t / tau)`` ft/s after t seconds."""

    tau: float
    steady: float
    lag: float


def bow(tm_diff: float, tau: float, reach: float) -> float:
    """Return how far a lag of 1 ft/s has a side ahead of its position at mean speed, averaged over the step, in ft.

    :param reach: the distance that this lag adds in the whole step
    """
    return tau - reach * (tau / tm_diff + 0.5) if tm_diff else 0.0


def along(tm_diff: float, turning: float, left: SideMotion, right: SideMotion) -> tuple[float, float]:
    """Return how far the robot's centre moves in a step of any length: feet forward and to the right.

    :param turning: radians clockwise that the robot turns for each foot that its left side is ahead of its right
    """
    (l_tau, l_steady, l_lag), (r_tau, r_steady, r_lag) = left, right
    # The greatest rate of turn: with different time constants it may lie within the step.
    before = abs(l_steady + l_lag - r_steady - r_lag)
    after = abs(l_steady + l_lag * math.exp(-tm_diff / l_tau) - r_steady - r_lag * math.exp(-tm_diff / r_tau))
    within = abs(r_lag) * abs(l_tau - r_tau) / max(l_tau, r_tau)
    variation = turning * (max(before, after) + within) * tm_diff + tm_diff / min(l_tau, r_tau)

    both, ahead = 0.5 * (l_steady + r_steady), turning * (l_steady - r_steady)
    x = y = 0.0
    for weight, time in _nodes(tm_diff, math.ceil(variation / EIGHT_NODES_SPAN)):
        l_left, r_left = math.exp(-time / l_tau), math.exp(-time / r_tau)
        angle = ahead * time + turning * (l_lag * l_tau * (1.0 - l_left) - r_lag * r_tau * (1.0 - r_left))
        length = weight * (both + 0.5 * (l_lag * l_left + r_lag * r_left))
        x += length * math.cos(angle)
        y += length * math.sin(angle)
    return x, y


def _nodes(tm_diff: float, panels: int) -> Iterator[tuple[float, float]]:
    """Return the weights, and the times since the start of the step."""
    length = tm_diff / panels
    for panel in range(panels):
        for position, weight in EIGHT_NODES:
            yield weight * length, (panel + position) * length
