"""Construct a robot with its project's physics. A project without physics.py never imports the physics package."""

from __future__ import annotations

from ..project import Project
from ..runtime.robot import RobotRun


def construct(project: Project, run: RobotRun, robot_class: type[object]) -> None:
    """Construct the robot and its physics in an open run."""
    if project.physics_file.is_file():
        from .engine import load_physics

        load_physics(project).attach(run)
    run.construct(robot_class)
