"""What is proposed for a robot: the files, and what they rest on. Made in the process that the robot's code runs in."""

from __future__ import annotations

from dataclasses import dataclass

from ...project import Project
from ...runtime.own_process import LastWords


@dataclass(frozen=True)
class Proposal:
    """For one robot.

    :param physics, config: the text of each file
    :param recognised: lines on the drivetrain, encoders and gyros found
    :param assumptions: sentences on what was taken for granted
    :param advice: sentences on what is left to do
    :param problem: why the sticks could not be tried
    """

    physics: str
    config: str
    recognised: list[str]
    assumptions: list[str]
    advice: list[str]
    problem: str | None


def propose(project: Project, last_words: LastWords) -> Proposal:
    """Look at the robot, and write nothing.

    :raises RobotCodeError: when the robot's code fails before it can be driven
    """
    # Here, since the process that asks needs none of it.
    from .config_file import config_text
    from .drivetrain import find_layout
    from .physics_file import physics_text
    from .report import advice, summary
    from .survey import survey

    found = survey(project, last_words)
    layout = find_layout(found)
    return Proposal(
        physics_text(found, layout),
        config_text(found),
        summary(layout, found),
        layout.assumptions,
        advice(layout),
        found.problem,
    )
