"""The shapes that a front end draws on the field, in feet, and what dragging the robot does."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal

from ...engine.scene import Field, Point, Pose, Tag

if TYPE_CHECKING:
    from ...engine.simulation import Simulation

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
