"""Create the proposed files for a robot, in the process that runs the robot's code."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...processes.crash_report import CrashLog
from ...project import Project

if TYPE_CHECKING:
    from .survey import Survey

#: The JSON Schema beside the configuration, for completion in editors.
SCHEMA_NAME = "config.schema.json"

#: The robot of the written ``physics.py``, 27.5 by 36.5 inches, in feet. It starts at the middle of the field's left
#: end, facing along the field.
_ROBOT = {"w": 2.29, "l": 3.04, "starting_x": 3, "starting_y": 13.2, "starting_angle": 0}


@dataclass(frozen=True)
class Proposal:
    """The proposal for a robot.

    :param physics: the text of ``physics.py``
    :param config: the text of ``sim/config.json``
    :param recognised: lines about the drivetrain, encoders and gyros
    :param assumptions: sentences about assumptions
    :param advice: sentences about remaining work
    :param problem: why the joysticks could not be tested
    """

    physics: str
    config: str
    recognised: list[str]
    assumptions: list[str]
    advice: list[str]
    problem: str | None


def propose(project: Project, log: CrashLog) -> Proposal:
    """Start the robot program and return a proposal; write nothing.

    :raises RobotCodeError: when the robot's code fails before it can be driven
    """
    # Imported here, since the parent process does not need them.
    from .drivetrain import find_layout
    from .physics_file import physics_text
    from .report import advice, summary
    from .survey import survey

    found = survey(project, log)
    layout = find_layout(found)
    return Proposal(
        physics_text(found, layout),
        _config_text(found),
        summary(layout, found),
        layout.assumptions,
        advice(found, layout),
        found.problem,
    )


def _config_text(found: Survey) -> str:
    """Return the text of ``sim/config.json``, with the robot and the names of its channels."""
    new = {"field": {"walls": True}, "robot": _ROBOT, **found.labels}
    content: dict[str, Any] = {"$schema": SCHEMA_NAME, "pyfrc": new}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
