"""What robot code draws on the simulated field."""

from __future__ import annotations

import math
import threading
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Protocol

from ....errors import UsageError
from ....runtime.patches.install import patches
from ..scene import Line, Point, Pose, Text
from .drawing_styles import line_style, text_style

#: The most drawings on the field; when there are more, the oldest are removed.
MOST_DRAWINGS = 500

#: ``True``: relative to the robot's centre; an (x, y): to that place on the robot, x to its right and y forward.
RobotCoordinates = bool | Point


class Segment(Protocol):
    """A segment of a trajectory: its place in feet, y to the left, and its duration in seconds."""

    x: float
    y: float
    dt: float


class UserRenderer:
    """Draws on the simulated field. May be used from any thread.

    Places are (x, y) in feet: on the field, x to the right and y downwards from its top left corner; in robot
    coordinates, x forward and y to the robot's right. An offset, a place on the robot, is (across, along) as its width
    and length are: x to the robot's right, y forward. The robot's place counts when something is drawn: the drawing
    stays there when the robot moves on. Drawing the same again changes nothing.

    :param robot: returns the robot's place
    """

    def __init__(self, robot: Callable[[], Pose | None]) -> None:
        self._robot = robot
        self._lock = threading.Lock()
        self._drawings: dict[str, Line | Text] = {}

    def drawings(self) -> tuple[Line | Text, ...]:
        """All that has been drawn, in order."""
        with self._lock:
            return tuple(self._drawings.values())

    def draw_line(
        self,
        line_pts: Sequence[Point],
        color: str = "#ff0000",
        robot_coordinates: RobotCoordinates = False,
        relative_to_first: bool = False,
        arrow: bool = True,
        scale: Point = (1, 1),
        **kwargs: object,
    ) -> None:
        """Draw a line through all of these points.

        :param line_pts: a list of (x, y) pairs, in feet
        :param color: as a 6-digit hex color
        :param robot_coordinates: if True, the line's first point is at the robot's centre, whatever its numbers are,
            and the line is turned as the robot is; if an (x, y), it starts at that place on the robot: x feet to the
            right of its centre, y feet ahead
        :param relative_to_first: if True, the points are moved so that the first is (0, 0)
        :param arrow: if True, there is an arrow at the end
        :param scale: all points are multiplied by this (x, y)
        :param kwargs: options of tkinter's `create_line`: `width`, `dash`, `smooth`, `capstyle`, `joinstyle`, `fill`
        """
        points = [_point(each) for each in line_pts]
        if len(points) < 2:
            raise UsageError(f"draw_line(line_pts): a line has two points or more, not {len(points)}")
        if relative_to_first or robot_coordinates is not False:
            first = points[0]
            points = [(x - first[0], y - first[1]) for x, y in points]
        self._add(_line(self._placed(points, robot_coordinates, scale), color, arrow, kwargs))

    def draw_text(
        self,
        text: str,
        pt: Point,
        color: str = "#000000",
        fontSize: int = 10,
        robot_coordinates: RobotCoordinates = False,
        scale: Point = (1, 1),
        arrow: bool = True,
        **kwargs: object,
    ) -> None:
        """Write a text on the field, its middle at a point.

        :param text: what to write
        :param pt: an (x, y), in feet
        :param color: as a 6-digit hex color
        :param fontSize: in points
        :param robot_coordinates: if True, the point is relative to the robot's centre; if an (x, y), to that place
            on the robot: x feet to the right of its centre, y feet ahead
        :param scale: the point is multiplied by this (x, y)
        :param arrow: has no effect, since texts have no arrow; it is accepted because it is documented
        :param kwargs: options of tkinter's `create_text`: `anchor`, `angle`, `justify`, `width`, `font`, `fill`
        """
        ((x, y),) = self._placed([_point(pt)], robot_coordinates, scale)
        style, color, size, problem = text_style({"color": color, **kwargs})
        self._add(Text(str(text), x, y, color, size or fontSize, style, problem))

    def draw_pathfinder_trajectory(
        self,
        trajectory: Iterable[Segment],
        color: str = "#ff0000",
        offset: Point | None = None,
        scale: Point = (1, 1),
        show_dt: float | bool = False,
        dt_offset: float = 0.0,
        **kwargs: object,
    ) -> None:
        """Draw a trajectory of `robotpy-pathfinder` (or any other whose segments have `x`, `y` and `dt`).

        It starts at the robot's centre, and goes the way the robot faces.

        :param trajectory: a list of segments; their y grows to the left, as in pathfinder
        :param color: as a 6-digit hex color
        :param offset: an (x, y) on the robot where the path starts: x feet to the right of its centre, y feet ahead
        :param scale: all points are multiplied by this (x, y)
        :param show_dt: write the time along the path at this interval, in seconds; False: not at all
        :param dt_offset: added to each time that is shown
        :param kwargs: options of tkinter's `create_line`: `width`, `dash`, `smooth`, `capstyle`, `joinstyle`, `fill`
        """
        segments = list(trajectory)
        if len(segments) < 2:
            raise UsageError(f"draw_pathfinder_trajectory: a path has two segments or more, not {len(segments)}")
        start = segments[0]
        path = [(each.x - start.x, start.y - each.y) for each in segments]
        where: RobotCoordinates = True if offset is None else _point(offset)
        placed = self._placed(path, where, scale)
        self._add(_line(placed, color, True, kwargs))
        if show_dt:
            every, due, elapsed = 1.0 if show_dt is True else float(show_dt), 0.0, 0.0
            for segment, (x, y) in zip(segments, placed, strict=True):
                if elapsed >= due - 1e-9:
                    self._add(Text(f"t={elapsed + dt_offset:.2f}", x, y, color))
                    due += every
                elapsed += segment.dt

    def _placed(self, points: list[Point], robot_coordinates: RobotCoordinates, scale: Point) -> tuple[Point, ...]:
        scale_x, scale_y = _point(scale)
        points = [(x * scale_x, y * scale_y) for x, y in points]
        if robot_coordinates is False:
            return tuple(points)
        across, along = (0.0, 0.0) if robot_coordinates is True else _point(robot_coordinates)
        robot = self._robot() or Pose(0.0, 0.0, 0.0)
        moved = (robot.moved(x + along, y + across, 0.0) for x, y in points)
        return tuple((pose.x, pose.y) for pose in moved)

    def _add(self, drawing: Line | Text) -> None:
        if drawing.problem:
            warnings.warn(drawing.problem, stacklevel=3)  # Python shows it once for each line of the robot's code
        key = repr(drawing)
        with self._lock:
            self._drawings.pop(key, None)
            self._drawings[key] = drawing
            if len(self._drawings) > MOST_DRAWINGS:
                del self._drawings[next(iter(self._drawings))]


def get_user_renderer() -> UserRenderer | None:
    """Return what draws on the simulated field; None where there is no field, as in tests."""
    run = patches.run
    renderer = None if run is None else run.renderer
    return renderer if isinstance(renderer, UserRenderer) else None


def _line(points: tuple[Point, ...], color: str, arrow: bool, options: Mapping[str, object]) -> Line:
    style, color, _, problem = line_style({"color": color, **options})
    return Line(points, color, arrow, style, problem)


def _point(value: Any) -> Point:
    try:
        x, y = value
        x, y = float(x), float(y)
    except (TypeError, ValueError):
        raise UsageError(f"{value!r} is no point: give an (x, y), in feet") from None
    if not math.isfinite(x + y):
        raise UsageError(f"{value!r} is no place: its numbers are not finite")
    return x, y
