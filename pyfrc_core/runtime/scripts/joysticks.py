"""The joysticks' controls as targets of input scripts, and which writes release them. Imports no WPILib."""

from __future__ import annotations

import re
from collections.abc import Mapping

#: A control of a joystick: its port, its sort, its number.
CONTROL = re.compile(r"joysticks\[([0-5])\]\.(axes|buttons|povs)\[(\d+)\]")
#: The values of controls that are not touched.
NEUTRAL: dict[str, object] = {"axes": 0.0, "buttons": False, "povs": -1}


def releases(values: Mapping[str, object]) -> dict[str, object]:
    """Return the writes that release the controls among these values, by target."""
    found = {}
    for target, value in values.items():
        if (control := CONTROL.fullmatch(target)) and value != (neutral := NEUTRAL[control[2]]):
            found[target] = neutral
    return found
