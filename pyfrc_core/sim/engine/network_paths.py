"""The paths of values that a simulation reports besides those of `hal_data`."""

from __future__ import annotations

#: What the path of a value of NetworkTables begins with, as in input scripts; and that of a topic's type.
VALUE, TYPE = "nt:", "type:"
#: The mode that the driver station asks for, as in `Snapshot.mode`; the robot's place: x, y and angle as in `Pose`.
MODE, POSE = "sim.mode", "sim.pose"
