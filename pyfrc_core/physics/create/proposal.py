"""Create the proposed files for a robot, in the process that runs the robot's code."""

from __future__ import annotations

from dataclasses import dataclass

from ...processes.crash_report import CrashLog
from ...project import Project


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
    from .config_file import config_text
    from .drivetrain import find_layout
    from .physics_file import physics_text
    from .report import advice, summary
    from .survey import survey

    found = survey(project, log)
    layout = find_layout(found)
    return Proposal(
        physics_text(found, layout),
        config_text(found),
        summary(layout, found),
        layout.assumptions,
        advice(layout),
        found.problem,
    )
