"""The robot's pose on the field, and moves along an arc.

Both views of `PhysicsInterface` are based on this pose: feet and clockwise radians, as in ``sim/config.json``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

METRES_PER_FOOT = 0.3048


class Pose(NamedTuple):
    """A pose on the field: x to the right and y downwards, in feet; the angle in radians clockwise from the x axis."""

    x: float
    y: float
    angle: float

    def moved(self, forward: float, right: float, turn: float) -> Pose:
        """Return the pose after a relative move: this far forward and to the right, then a clockwise turn."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return Pose(
            self.x + forward * cos - right * sin,
            self.y + forward * sin + right * cos,
            self.angle + turn,
        )


def along_arc(forward: float, right: float, turn: float) -> tuple[float, float]:
    """Return the displacement of a robot that moves with constant velocities, relative to its start.

    The exponential map of SE(2): Lynch and Park, *Modern Robotics*, section 3.2. Written with the half angle, which is
    accurate for small turns.

    :param forward: the distance that its forward velocity would give without turning; likewise `right`
    :param turn: the angle of the turn, in radians
    :returns: the displacement forward and to the right, in the unit of these two
    """
    half = 0.5 * turn
    if half == 0.0:
        return forward, right
    chord = math.sin(half) / half
    along, across = chord * math.cos(half), chord * math.sin(half)
    return forward * along - right * across, forward * across + right * along
