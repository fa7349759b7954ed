"""Which part of the field is to be seen, and where on the screen: arithmetic, without a window."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

#: How far one can zoom in, beside the whole field; and out.
NEAREST, FARTHEST = 24.0, 0.5

#: So much of the screen stays free around the whole field.
_MARGIN = 0.035


@dataclass(frozen=True)
class Viewport:
    """A field of so many feet seen on a screen of so many pixels; both with y downwards.

    :param zoom: 1 shows the whole field
    :param center_x: the place on the field in the screen's middle, in feet; likewise `center_y`
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
        """The whole field in the middle of the screen."""
        return cls(field_width, field_height, max(width, 1), max(height, 1), 1.0, field_width / 2, field_height / 2)

    @property
    def scale(self) -> float:
        """Pixels a foot."""
        free = 1 - 2 * _MARGIN
        return self.zoom * free * min(self.width / self.field_width, self.height / self.field_height)

    def to_screen(self, x: float, y: float) -> tuple[float, float]:
        """Where a place on the field is seen, in pixels."""
        scale = self.scale
        return (x - self.center_x) * scale + self.width / 2, (y - self.center_y) * scale + self.height / 2

    def to_field(self, pixel_x: float, pixel_y: float) -> tuple[float, float]:
        """Which place on the field is seen at a pixel, in feet."""
        scale = self.scale
        return (pixel_x - self.width / 2) / scale + self.center_x, (pixel_y - self.height / 2) / scale + self.center_y

    def line(self, points: Iterable[tuple[float, float]]) -> list[float]:
        """Places on the field as a canvas takes them: x, y, x, y, in pixels."""
        scale = self.scale
        left, top = self.width / 2 - self.center_x * scale, self.height / 2 - self.center_y * scale
        return [pixel for x, y in points for pixel in (x * scale + left, y * scale + top)]

    def zoomed(self, factor: float, pixel_x: float, pixel_y: float) -> Viewport:
        """Nearer (a factor above 1) or farther; what is seen at the pixel stays there."""
        x, y = self.to_field(pixel_x, pixel_y)
        nearer = replace(self, zoom=min(max(self.zoom * factor, FARTHEST), NEAREST))
        new_x, new_y = nearer.to_field(pixel_x, pixel_y)
        return nearer.centered(nearer.center_x + x - new_x, nearer.center_y + y - new_y)

    def panned(self, pixels_x: float, pixels_y: float) -> Viewport:
        """The field moved on the screen by so many pixels."""
        return self.centered(self.center_x - pixels_x / self.scale, self.center_y - pixels_y / self.scale)

    def resized(self, width: int, height: int) -> Viewport:
        """The same middle on a screen of another size."""
        return replace(self, width=max(width, 1), height=max(height, 1))

    def centered(self, x: float, y: float) -> Viewport:
        """Another place in the middle; one that is on the field, lest it be lost from sight."""
        return replace(self, center_x=min(max(x, 0.0), self.field_width), center_y=min(max(y, 0.0), self.field_height))
