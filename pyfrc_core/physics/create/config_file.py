"""The text of ``sim/config.json`` for a robot."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .survey import Survey

#: What editors complete the configuration's keys from; beside it.
SCHEMA_NAME = "config.schema.json"

#: The robot of the written ``physics.py``, 27.5 by 36.5 inches, in feet; it starts at the middle of the field's left
#: end, looking along it.
_ROBOT = {"w": 2.29, "l": 3.04, "starting_x": 3, "starting_y": 13.2, "starting_angle": 0}


def config_text(found: Survey) -> str:
    """The whole file: the robot, and what its channels are called."""
    content: dict[str, Any] = {"$schema": SCHEMA_NAME, "pyfrc": {"robot": _ROBOT, **found.labels}}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
