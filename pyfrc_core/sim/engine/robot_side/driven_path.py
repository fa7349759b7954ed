"""The path that a robot has driven."""

from __future__ import annotations

import math

from ..scene import Point

#: The trail gets a point after this distance, in feet.
_TRAIL_STEP = 0.05


class DrivenPath:
    """The points of a robot's trail, and how far it has driven."""

    def __init__(self) -> None:
        #: The points that were not reported yet.
        self.points: list[Point] = []
        #: In feet.
        self.distance = 0.0
        self._at: Point | None = None
        self._end: Point = (math.nan, math.nan)

    def add(self, x: float, y: float) -> None:
        """Note where the robot is."""
        if self._at is not None:
            self.distance += math.dist(self._at, (x, y))
        self._at = (x, y)
        if not abs(x - self._end[0]) + abs(y - self._end[1]) < _TRAIL_STEP:
            self._end = self._at
            self.points.append(self._at)
