"""The seasons' fields, as WPILib's optional library of fields knows them."""

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
    if importlib.util.find_spec("robotpy_fields") is None:
        return
    from robotpy_fields import FieldId, get_field

    for name, number in FieldId.__members__.items():
        if name.startswith(f"FRC_{year}_"):
            field = get_field(number)
            placed = [(tag.id, tag.pose.to_pose2d()) for tag in field.get_tags()]
            tags = tuple(FieldTag(number, at.x, at.y, at.rotation().radians()) for number, at in placed)
            yield TaggedField(field.get_length(), field.get_width(), tags)
