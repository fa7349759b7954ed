"""A robot with the physics of its project; a project without any never imports them."""

from __future__ import annotations

from typing import Any

from ..project import Project
from ..runtime.robot import RobotRun


def construct(project: Project, run: RobotRun, robot_class: type[Any]) -> None:
    """Make the robot, with the project's physics, in a run that is open."""
    if project.physics_file.is_file():
        from .engine import load_physics

        load_physics(project).attach(run)
    run.construct(robot_class)
