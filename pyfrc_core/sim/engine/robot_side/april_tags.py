"""The AprilTags of a project's field: those of the season, if its size is the season's."""

from __future__ import annotations

import math

from ....config.sim import SimConfig
from ....physics.pose import METRES_PER_FOOT
from ....season import CURRENT
from ....wpi import fields
from ..scene import Tag

#: Tags are drawn where the field's size differs from theirs by less than this, in feet.
_SAME_SIZE = 1.0


def tags_of(config: SimConfig) -> tuple[Tag, ...]:
    """Return the AprilTags, where WPILib's library of them is installed."""
    field = config.field
    for known in fields.tagged_fields(str(field.season or CURRENT.year)):
        length, width = known.length / METRES_PER_FOOT, known.width / METRES_PER_FOOT
        if math.dist((length, width), (field.w, field.h)) < _SAME_SIZE:
            return tuple(
                Tag(tag.number, tag.x / METRES_PER_FOOT, field.h - tag.y / METRES_PER_FOOT, -tag.angle)
                for tag in known.tags
            )
    return ()
