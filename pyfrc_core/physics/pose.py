"""Where the robot is on the field, and how it gets from there along an arc.

The one pose underneath both of `PhysicsInterface`'s views: feet and clockwise radians, as in ``sim/config.json``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

METRES_PER_FOOT = 0.3048


class Pose(NamedTuple):
    """A place on the field: x to the right and y downwards, in feet; clockwise radians from the direction of x."""

    x: float
    y: float
    angle: float

    def moved(self, forward: float, right: float, turn: float) -> Pose:
        """The pose after a move as seen from this one: so many feet forward and to the right, then so far clockwise."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return Pose(
            self.x + forward * cos - right * sin,
            self.y + forward * sin + right * cos,
            self.angle + turn,
        )


def along_arc(forward: float, right: float, turn: float) -> tuple[float, float]:
    """Where a robot ends that moves with constant velocities, relative to where it began.

    :param forward: how far its velocity forward would have brought it without turning; likewise `right`
    :param turn: the angle it has turned meanwhile, in radians
    :returns: how far it has come forward and to the right, in the unit of these two

    The exponential map of SE(2): Lynch and Park, *Modern Robotics*, section 3.2. Written with the half angle, which
    loses no digits when the turn is small.
    """
    half = 0.5 * turn
    if half == 0.0:
        return forward, right
    chord = math.sin(half) / half
    along, across = chord * math.cos(half), chord * math.sin(half)
    return forward * along - right * across, forward * across + right * along
