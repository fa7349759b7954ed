"""The path that a robot has driven."""

from __future__ import annotations

import math

from ....physics.pose import Pose, Walls
from ..scene import Point

#: The trail gets a point after this distance, in feet.
_TRAIL_STEP = 0.05


class DrivenPath:
    """The points of a robot's trail, how far it has driven, and whether it has left the field."""

    def __init__(self, walls: Walls) -> None:
        self._walls = walls
        self._left = False
        #: The points that were not reported yet.
        self.points: list[Point] = []
        #: In feet.
        self.distance = 0.0
        self._at: Point | None = None
        self._end: Point = (math.nan, math.nan)

    def add(self, pose: Pose) -> str:
        """Note where the robot is, and return what the user is to know of it: an empty text, or that it is outside."""
        x, y = pose[:2]
        if self._at is not None:
            self.distance += math.dist(self._at, (x, y))
        self._at = (x, y)
        if not abs(x - self._end[0]) + abs(y - self._end[1]) < _TRAIL_STEP:
            self._end = self._at
            self.points.append(self._at)
        if self._left or not self._walls.are_passed(pose):
            return ""
        self._left = True  # one that drives to and fro says it once
        across, down = self._walls[:2]
        return (
            f"The robot has left the field: x = {x:.1f} ft of {across:.1f}, y = {y:.1f} ft of {down:.1f}. "
            'For walls that hold it, write "walls": true under pyfrc.field in sim/config.json.'
        )
