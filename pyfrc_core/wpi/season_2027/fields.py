"""The seasons' fields, as WPILib's optional library of AprilTags knows them."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from typing import NamedTuple


class FieldTag(NamedTuple):
    """An AprilTag on a field: metres and counter-clockwise radians, as robot code has them."""

    number: int
    x: float
    y: float
    angle: float


class TaggedField(NamedTuple):
    """A field, with its length and width in metres."""

    length: float
    width: float
    tags: tuple[FieldTag, ...]


def tagged_fields(year: str) -> Iterator[TaggedField]:
    """Yield the fields of a season; none if the library is not installed."""
    if importlib.util.find_spec("robotpy_apriltag") is None:
        return
    from robotpy_apriltag import AprilTagField, AprilTagFieldLayout

    for name, field in AprilTagField.__members__.items():
        if year in name:
            layout = AprilTagFieldLayout.load_field(field)
            placed = [(tag.ID, tag.pose.to_pose2d()) for tag in layout.get_tags()]
            tags = tuple(FieldTag(number, at.X(), at.Y(), at.rotation().radians()) for number, at in placed)
            yield TaggedField(layout.get_field_length(), layout.get_field_width(), tags)
