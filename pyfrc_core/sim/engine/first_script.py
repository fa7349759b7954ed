"""The script that a simulated robot starts with: the user's, or where it stands and whose robot it is."""

from __future__ import annotations

from dataclasses import replace

from ...runtime.scripts.script import InputScript, Step
from .field import robot_at, start_named
from .left_behind import ending_released
from .options import SimOptions
from .scene import Field


def first_script(options: SimOptions, robot: str, field: Field) -> InputScript:
    """Return the inputs at the robot's start, and later those of the options' script.

    :param robot: the name of the robot's file
    :raises UsageError: when the field has no such start
    """
    start = start_named(field, options.start_position)
    if options.script is None:
        # The blue alliance's wall is at x = 0: a robot of the other one would drive into the wall behind it.
        station = "blue1" if start.x < field.width / 2 else "red1"
        script = InputScript((Step(0, {"alliance_station": station}),), 0, robot=robot)
    else:
        script = ending_released(options.script)
    if options.start_position is None:
        return script
    return replace(script, steps=(Step(0, robot_at(field, start)), *script.steps))
