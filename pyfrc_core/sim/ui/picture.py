"""A picture of the field with the robot's path, for a pull request or a lab report.

Drawn by Pillow, an optional extra: tests and most simulations need no picture.
"""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ..._version import requirement
from ...errors import UsageError
from ..engine.scene import Field, Line, Point, Pose, Scene

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

#: The longer side of the picture, and the margin for the scale around the field, in pixels.
_LONGER_SIDE = 1200
_MARGIN = 28
#: The distance of the grid's lines, in feet; every second line has its number.
_GRID = 5
_BACKGROUND, _FLOOR, _EDGE, _LINE = "#ffffff", "#e8e8e8", "#404040", "#d0d0d0"
_TRAIL, _FORMER, _ROBOT, _TAG, _TARGET = "#0057b8", "#f0a030", "#d00000", "#303030", "#00a040"


def check_pictures(file: Path) -> None:
    """Check that a picture can be drawn into this file.

    :raises UsageError: saying what to do
    """
    if importlib.util.find_spec("PIL") is None:
        raise UsageError(
            "drawing a picture needs Pillow", remedy=f'Install it with: pip install "{requirement("picture")}"'
        )
    from PIL import Image

    known = Image.registered_extensions()
    if file.suffix.lower() not in known:
        raise UsageError(f"{file}: this is no kind of picture that is known", remedy="Name it, for example, path.png.")


def draw_picture(scene: Scene, file: Path, former_trail: Iterable[Point] = ()) -> None:
    """Draw what is on the field.

    :param former_trail: the path before, drawn in another colour
    :raises UsageError: when the file cannot be written
    """
    check_pictures(file)
    from PIL import Image, ImageDraw

    field = scene.field
    scale = (_LONGER_SIDE - 2 * _MARGIN) / max(field.width, field.height)
    size = round(field.width * scale) + 2 * _MARGIN, round(field.height * scale) + 2 * _MARGIN
    image = Image.new("RGB", size, _BACKGROUND)
    drawing = _Drawing(ImageDraw.Draw(image), scale)
    drawing.polygon([(0, 0), (field.width, 0), (field.width, field.height), (0, field.height)], _FLOOR)
    if field.image is not None:
        _paste(field.image, image)
    drawing.grid(field)
    for shape in field.objects:
        drawing.polygon(shape.points, _color(shape.color))
    for tag in field.tags:
        drawing.tag(tag.x, tag.y, tag.angle, str(tag.number))
    for target in scene.targets:
        drawing.spot((target.x, target.y), _TARGET, filled=target.in_view)
    drawing.line(list(former_trail), _FORMER, 2)
    drawing.line(scene.trail, _TRAIL, 3)
    if scene.trail:
        drawing.start(scene.trail[0])
    for each in scene.drawings:
        if isinstance(each, Line):
            drawing.line(each.points, _color(each.color), 2)
        else:
            drawing.text((each.x, each.y), each.text, _color(each.color), each.size)
    if scene.robot is not None:
        drawing.robot(scene.robot, field)
    drawing.line([(0, 0), (field.width, 0), (field.width, field.height), (0, field.height), (0, 0)], _EDGE, 2)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        image.save(file)
    except OSError as error:
        raise UsageError(f"{file} cannot be written: {error.strerror or error}") from None


def _paste(file: Path, image: object) -> None:
    from PIL import Image

    try:
        with Image.open(file) as picture:
            width, height = image.size  # type: ignore[attr-defined]
            fitted = picture.convert("RGB").resize((width - 2 * _MARGIN, height - 2 * _MARGIN))
            image.paste(fitted, (_MARGIN, _MARGIN))  # type: ignore[attr-defined]
    except OSError as error:
        raise UsageError(
            f"{file.name} is no picture that can be read: {error}", where="sim/config.json: pyfrc.field.image"
        ) from None


def _color(name: str) -> str:
    """Return the colour; black for a name that Pillow does not know, since tkinter knows more names."""
    from PIL import ImageColor

    try:
        ImageColor.getrgb(name)
    except ValueError:
        return "#000000"
    return name


class _Drawing:
    """Draws in feet."""

    def __init__(self, draw: ImageDraw, scale: float) -> None:
        self._draw = draw
        self._scale = scale

    def polygon(self, points: Iterable[Point], color: str) -> None:
        """Draw a filled polygon."""
        self._draw.polygon(self._pixels(points), fill=color)

    def line(self, points: Iterable[Point], color: str, width: int) -> None:
        """Draw a line through all points."""
        pixels = self._pixels(points)
        if len(pixels) > 1:
            self._draw.line(pixels, fill=color, width=width, joint="curve")

    def spot(self, point: Point, color: str, filled: bool) -> None:
        """Draw a round mark."""
        ((x, y),) = self._pixels([point])
        self._draw.ellipse((x - 5, y - 5, x + 5, y + 5), outline=color, fill=color if filled else None, width=2)

    def text(self, point: Point, text: str, color: str, size: int, beside: tuple[int, int] = (0, 0)) -> None:
        """Draw a text; its middle is `beside` the point, in pixels."""
        from PIL import ImageFont

        ((x, y),) = self._pixels([point])
        at = x + beside[0], y + beside[1]
        self._draw.text(at, text, fill=color, font=ImageFont.load_default(size), anchor="mm")

    def grid(self, field: Field) -> None:
        """Draw the grid, with numbers below the field and at its left."""
        half = _MARGIN // 2
        for x in range(0, math.floor(field.width) + 1, _GRID):
            self.line([(x, 0), (x, field.height)], _LINE, 1)
            if x % (2 * _GRID) == 0:
                self.text((x, field.height), f"{x} ft", _EDGE, 12, (0, half))
        for y in range(0, math.floor(field.height) + 1, _GRID):
            self.line([(0, y), (field.width, y)], _LINE, 1)
            if y % (2 * _GRID) == 0 and y:
                self.text((0, y), f"{y} ft", _EDGE, 12, (-half, 0))

    def start(self, point: Point) -> None:
        """Mark where the robot has started."""
        self.spot(point, _TRAIL, filled=True)
        self.text(point, "start", _TRAIL, 12, (0, 14))

    def tag(self, x: float, y: float, angle: float, number: str) -> None:
        """Draw a tag as a short wall seen from above, with its number behind it."""
        pose = Pose(x, y, angle)
        ends = [pose.moved(0, side, 0) for side in (-0.4, 0.4)]
        self.line([(end.x, end.y) for end in ends], _TAG, 4)
        behind = pose.moved(0.5, 0, 0)
        self.text((behind.x, behind.y), number, _TAG, 10)

    def robot(self, pose: Pose, field: Field) -> None:
        """Draw the robot, with an arrow to its front."""
        length, width = field.robot_length / 2, field.robot_width / 2
        corners = [(length, -width), (length, width), (-length, width), (-length, -width)]
        outline = [pose.moved(forward, right, 0) for forward, right in corners]
        points = [(corner.x, corner.y) for corner in outline]
        self.line([*points, points[0]], _ROBOT, 3)
        tip = pose.moved(length, 0, 0)
        barbs = [tip.moved(-0.6 * length * math.cos(a), 0.6 * length * math.sin(a), 0) for a in (-0.5, 0.5)]
        self.line([(pose.x, pose.y), (tip.x, tip.y)], _ROBOT, 2)
        for barb in barbs:
            self.line([(tip.x, tip.y), (barb.x, barb.y)], _ROBOT, 2)

    def _pixels(self, points: Iterable[Point]) -> list[tuple[float, float]]:
        scale = self._scale
        return [(_MARGIN + x * scale, _MARGIN + y * scale) for x, y in points]
