"""The robot's pose on the field, and moves along an arc.

Both views of `PhysicsInterface` are based on this pose: feet and clockwise radians, as in ``sim/config.json``.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ..config.sim import SimConfig

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


class Walls(NamedTuple):
    """The walls around a field: its size along x and y, and the robot's length and width, in feet."""

    across: float
    down: float
    length: float
    width: float

    def keep_in(self, pose: Pose) -> Pose:
        """Return the pose nearest to this one at which no corner of the robot is behind a wall."""
        cos, sin = abs(math.cos(pose.angle)), abs(math.sin(pose.angle))
        half_x = min(self.length * cos + self.width * sin, self.across) / 2
        half_y = min(self.length * sin + self.width * cos, self.down) / 2
        return Pose(
            min(max(pose.x, half_x), self.across - half_x),
            min(max(pose.y, half_y), self.down - half_y),
            pose.angle,
        )

    def are_passed(self, pose: Pose) -> bool:
        """Return whether the robot is outside, all of it and whichever way it is turned."""
        far = math.hypot(self.length, self.width) / 2
        return not (-far <= pose.x <= self.across + far and -far <= pose.y <= self.down + far)


def walls_of(config: SimConfig) -> Walls:
    """Return the walls around a project's field, whether or not they hold its robot."""
    return Walls(config.field.w, config.field.h, config.robot.l, config.robot.w)


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
