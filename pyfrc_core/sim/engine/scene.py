"""What there is to be seen on the field, as plain data: every front end shows the same.

Places are as in ``sim/config.json``: feet, x to the right and y downwards from the field's top left corner; angles in
radians, clockwise from the direction of x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...physics.pose import Pose as Pose

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

    :param angle: which way it faces
    """

    number: int
    x: float
    y: float
    angle: float


@dataclass(frozen=True)
class Field:
    """What stays the same all through a simulation.

    :param width: feet along x
    :param height: feet along y
    :param px_per_ft: the scale that the drawing is made for, in pixels
    :param image: a picture to lie under it all, stretched over the whole field
    :param robot_width: feet from the robot's left to its right
    :param robot_length: feet from its back to its front
    :param starts: where the robot may start, by name; the first is where it does
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


@dataclass(frozen=True)
class Line:
    """What `UserRenderer.draw_line` has drawn.

    :param arrow: whether there is an arrow at its end
    :param options: what else was said, for `tkinter`'s ``create_line``
    """

    points: tuple[Point, ...]
    color: str = "#ff0000"
    arrow: bool = True
    options: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Text:
    """What `UserRenderer.draw_text` has drawn: its middle is at (x, y).

    :param size: of the letters, in points
    :param options: what else was said, for `tkinter`'s ``create_text``
    """

    text: str
    x: float
    y: float
    color: str = "#000000"
    size: int = 10
    options: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Target:
    """What a `VisionSim` looks for.

    :param in_view: whether it sees it now
    """

    x: float
    y: float
    in_view: bool


@dataclass(frozen=True)
class Scene:
    """What is on the field at one moment.

    :param robot: where the robot is: its centre, and which way it faces. None without a ``physics.py``
    :param trail: where it has been, oldest first
    :param drawings: the user's own, in the order in which they were drawn
    """

    field: Field
    robot: Pose | None = None
    trail: tuple[Point, ...] = ()
    drawings: tuple[Line | Text, ...] = ()
    targets: tuple[Target, ...] = ()
