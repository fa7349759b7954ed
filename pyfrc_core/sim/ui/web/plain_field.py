"""The field as a page draws it."""

from __future__ import annotations

import hashlib
from typing import Any

from ...engine.scene import Field


def plain_field(field: Field, image: str) -> dict[str, Any]:
    """Return a field for a page.

    :param image: the address of its picture, if it has one
    """
    return {
        "width": field.width,
        "height": field.height,
        "image": None if field.image is None else f"{image}&v={_stamp(field)}",
        "robot_width": field.robot_width,
        "robot_length": field.robot_length,
        "starts": {name: [pose.x, pose.y, pose.angle] for name, pose in field.starts.items()},
        "objects": [{"color": shape.color, "points": shape.points} for shape in field.objects],
        "tags": [{"number": tag.number, "x": tag.x, "y": tag.y, "angle": tag.angle} for tag in field.tags],
    }


def _stamp(field: Field) -> str:
    """Return a text that changes with the picture."""
    try:
        status = field.image.stat() if field.image is not None else None
    except OSError:
        status = None
    text = f"{field.image} {status and (status.st_mtime_ns, status.st_size)}"
    return hashlib.sha256(text.encode()).hexdigest()[:12]
