"""What is on the field, as plain data: every front end shows the same.

Places are given as in ``sim/config.json``: feet, x to the right and y downwards from the field's top left corner.
Angles are in radians, clockwise from the direction of x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ...physics.pose import Pose as Pose
from ...season import FieldPart

Point = tuple[float, float]


@dataclass(frozen=True)
class Shape:
    """A filled polygon on the field.

    :param color: a colour's name, or ``#rrggbb``
    """

    color: str
    points: tuple[Point, ...]


@dataclass(frozen=True)
class Tag:
    """An AprilTag, seen from above.

    :param angle: the direction that it faces
    """

    number: int
    x: float
    y: float
    angle: float


@dataclass(frozen=True)
class Field:
    """The field and the robot's size, which stay the same throughout a simulation.

    :param width: feet along x
    :param height: feet along y
    :param px_per_ft: pixels per foot, as the configuration says
    :param image: a picture under everything else, stretched over the whole field
    :param robot_width: feet from the robot's left to its right
    :param robot_length: feet from its back to its front
    :param starts: the places where the robot may start, by name; the first is the default
    :param parts: the season's structures and lines, where no picture shows them
    :param coordinates: how the page writes places, as ``sim/config.json`` says
    """

    width: float
    height: float
    px_per_ft: float
    robot_width: float
    robot_length: float
    starts: Mapping[str, Pose]
    image: Path | None = None
    objects: tuple[Shape, ...] = ()
    tags: tuple[Tag, ...] = ()
    coordinates: str = "pyfrc"
    parts: tuple[FieldPart, ...] = ()


@dataclass(frozen=True)
class LineStyle:
    """How a line looks. Lengths are in pixels of the screen, whatever the zoom.

    :param width: None: the front end's own
    :param dash: the lengths of dashes and gaps, in turn; empty: an unbroken line
    :param smooth: whether to draw a curve instead of straight segments
    :param cap: how the line ends: ``butt``, ``projecting`` or ``round``
    :param join: how its segments meet: ``bevel``, ``miter`` or ``round``
    """

    width: float | None = None
    dash: tuple[int, ...] = ()
    smooth: bool = False
    cap: str = "butt"
    join: str = "round"


@dataclass(frozen=True)
class TextStyle:
    """How a text looks.

    :param anchor: which part of the text is at its place: ``center``, or a direction of the compass such as ``w``
    :param angle: in degrees, counterclockwise
    :param justify: of several lines: ``left``, ``center`` or ``right``
    :param width: the length at which lines are broken, in pixels; 0: nowhere
    :param family: the font's name; empty: the front end's own
    :param bold: whether the letters are bold; `italic` and `underline` likewise
    """

    anchor: str = "center"
    angle: float = 0.0
    justify: str = "left"
    width: float = 0.0
    family: str = ""
    bold: bool = False
    italic: bool = False
    underline: bool = False


@dataclass(frozen=True)
class Line:
    """A line that `UserRenderer.draw_line` has drawn.

    :param arrow: whether there is an arrow at its end
    :param problem: why it cannot be drawn, as a sentence for the user; empty: it can
    """

    points: tuple[Point, ...]
    color: str = "#ff0000"
    arrow: bool = True
    style: LineStyle = LineStyle()
    problem: str = ""


@dataclass(frozen=True)
class Text:
    """A text that `UserRenderer.draw_text` has drawn at (x, y).

    :param size: the size of the letters, in points
    :param problem: why it cannot be drawn, as a sentence for the user; empty: it can
    """

    text: str
    x: float
    y: float
    color: str = "#000000"
    size: int = 10
    style: TextStyle = TextStyle()
    problem: str = ""


@dataclass(frozen=True)
class Target:
    """A target of a `VisionSim`.

    :param in_view: whether the camera sees it now
    """

    x: float
    y: float
    in_view: bool


@dataclass(frozen=True)
class Scene:
    """What is on the field at one moment.

    :param robot: the robot's centre, and the direction that it faces; None without a ``physics.py``
    :param trail: the places where it has been, oldest first
    :param drawings: the user's drawings, in the order in which they were drawn
    """

    field: Field
    robot: Pose | None = None
    trail: tuple[Point, ...] = ()
    drawings: tuple[Line | Text, ...] = ()
    targets: tuple[Target, ...] = ()
