"""The part of the field that is visible, its place on the screen, the shapes on it, and what dragging a robot does."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Literal

from ...engine.scene import Field, Point, Pose, Tag
from ...engine.simulation import Simulation

#: The limits of zooming in and out; 1 shows the whole field.
NEAREST, FARTHEST = 24.0, 0.5

#: The share of the screen that stays free around the whole field.
_MARGIN = 0.035


@dataclass(frozen=True)
class Viewport:
    """A field, in feet, seen on a screen, in pixels; on both, y points downwards.

    :param zoom: 1 shows the whole field
    :param center_x: the place on the field in the middle of the screen, in feet; `center_y` likewise
    """

    field_width: float
    field_height: float
    width: int
    height: int
    zoom: float
    center_x: float
    center_y: float

    @classmethod
    def whole(cls, field_width: float, field_height: float, width: int, height: int) -> Viewport:
        """Return the view of the whole field."""
        return cls(field_width, field_height, max(width, 1), max(height, 1), 1.0, field_width / 2, field_height / 2)

    @property
    def scale(self) -> float:
        """Pixels per foot."""
        free = 1 - 2 * _MARGIN
        return self.zoom * free * min(self.width / self.field_width, self.height / self.field_height)

    def to_screen(self, x: float, y: float) -> tuple[float, float]:
        """Return the pixel of a place on the field."""
        scale = self.scale
        return (x - self.center_x) * scale + self.width / 2, (y - self.center_y) * scale + self.height / 2

    def to_field(self, pixel_x: float, pixel_y: float) -> tuple[float, float]:
        """Return the place on the field at a pixel, in feet."""
        scale = self.scale
        return (pixel_x - self.width / 2) / scale + self.center_x, (pixel_y - self.height / 2) / scale + self.center_y

    def line(self, points: Iterable[tuple[float, float]]) -> list[float]:
        """Return the pixels of places on the field as one list: x, y, x, y."""
        scale = self.scale
        left, top = self.width / 2 - self.center_x * scale, self.height / 2 - self.center_y * scale
        return [pixel for x, y in points for pixel in (x * scale + left, y * scale + top)]

    def zoomed(self, factor: float, pixel_x: float, pixel_y: float) -> Viewport:
        """Return the view zoomed in (a factor above 1) or out; the place at the pixel stays there."""
        x, y = self.to_field(pixel_x, pixel_y)
        nearer = replace(self, zoom=min(max(self.zoom * factor, FARTHEST), NEAREST))
        new_x, new_y = nearer.to_field(pixel_x, pixel_y)
        return nearer.centered(nearer.center_x + x - new_x, nearer.center_y + y - new_y)

    def panned(self, pixels_x: float, pixels_y: float) -> Viewport:
        """Return the view with the field moved by this many pixels."""
        return self.centered(self.center_x - pixels_x / self.scale, self.center_y - pixels_y / self.scale)

    def resized(self, width: int, height: int) -> Viewport:
        """Return the view with the same middle on a screen of another size."""
        return replace(self, width=max(width, 1), height=max(height, 1))

    def centered(self, x: float, y: float) -> Viewport:
        """Return the view with another place in the middle, limited to the field, so that it stays visible."""
        return replace(self, center_x=min(max(x, 0.0), self.field_width), center_y=min(max(y, 0.0), self.field_height))


#: The distance between grid lines, in feet; on a huge field they are farther apart.
_GRID, _MOST_LINES = 5.0, 60
#: Half the width of a tag, and the distance of its number behind it, in feet.
_TAG_HALF, _TAG_NUMBER = 0.35, 0.8


def grid_lines(field: Field) -> Iterator[tuple[Point, Point]]:
    """Yield the ends of the grid's lines."""
    w, h = field.width, field.height
    step = max(_GRID, max(w, h) / _MOST_LINES)
    for number in range(1, math.ceil(w / step)):
        yield (number * step, 0.0), (number * step, h)
    for number in range(1, math.ceil(h / step)):
        yield (0.0, number * step), (w, number * step)


def tag_marks(tag: Tag) -> tuple[tuple[Point, Point], Point]:
    """Return the ends of the line that shows a tag, and the place of its number."""
    sin, cos = math.sin(tag.angle), math.cos(tag.angle)
    across_x, across_y = -sin * _TAG_HALF, cos * _TAG_HALF
    ends = (tag.x - across_x, tag.y - across_y), (tag.x + across_x, tag.y + across_y)
    return ends, (tag.x + cos * _TAG_NUMBER, tag.y + sin * _TAG_NUMBER)


def robot_polygons(field: Field, robot: Pose) -> tuple[tuple[Point, ...], ...]:
    """Return the corners of the robot's bumpers, of its body inside them, and of the arrow that shows its front."""
    l, w = field.robot_length / 2, field.robot_width / 2  # noqa: E741
    bumper = 0.18 * min(l, w)
    shapes = (
        ((l, w), (l, -w), (-l, -w), (-l, w)),
        ((l - bumper, w - bumper), (l - bumper, bumper - w), (bumper - l, bumper - w), (bumper - l, w - bumper)),
        ((l - bumper * 1.6, 0.0), (l * 0.2, w * 0.45), (l * 0.2, -w * 0.45)),
    )
    return tuple(tuple(robot.moved(x, y, 0.0)[:2] for x, y in corners) for corners in shapes)


class RobotDrag:
    """Moving or turning the robot by dragging it on the field.

    :param place: a point of the robot, where the drag begins; in feet, as all places here
    """

    def __init__(self, simulation: Simulation, robot: Pose, place: Point, kind: Literal["move", "turn"]) -> None:
        self._simulation, self._kind = simulation, kind
        self._held = robot.x - place[0], robot.y - place[1]

    def drag(self, robot: Pose, place: Point) -> None:
        """Move the robot by as much as the pointer has moved, or turn its front towards the pointer.

        :param robot: where the robot is now
        """
        if self._kind == "move":
            x, y = place[0] + self._held[0], place[1] + self._held[1]
            self._simulation.place(x, y, math.degrees(robot.angle))
        else:
            angle = math.atan2(place[1] - robot.y, place[0] - robot.x)
            self._simulation.place(robot.x, robot.y, math.degrees(angle))


def is_on_robot(field: Field, robot: Pose | None, place: Point) -> bool:
    """Return whether a place on the field is within reach of the robot's centre."""
    if robot is None:
        return False
    reach = max(field.robot_length, field.robot_width) / 2
    return math.hypot(place[0] - robot.x, place[1] - robot.y) < reach
