"""Write the text of a robot's ``sim/config.json``."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .survey import Survey

#: The JSON Schema beside the configuration, for completion in editors.
SCHEMA_NAME = "config.schema.json"

#: The robot of the written ``physics.py``, 27.5 by 36.5 inches, in feet. It starts at the middle of the field's left
#: end, facing along the field.
_ROBOT = {"w": 2.29, "l": 3.04, "starting_x": 3, "starting_y": 13.2, "starting_angle": 0}


def config_text(found: Survey) -> str:
    """Return the text of the file, with the robot and the names of its channels."""
    content: dict[str, Any] = {"$schema": SCHEMA_NAME, "pyfrc": {"robot": _ROBOT, **found.labels}}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
