"""The part of the field that is visible, and its place on the screen."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

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
