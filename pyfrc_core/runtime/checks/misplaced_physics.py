"""Find a physics module in a place where pyfrc does not read it: nothing would move, without an error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .code_warning import CodeWarning

if TYPE_CHECKING:
    from ...project import Project


def find_misplaced_physics(project: Project) -> list[CodeWarning]:
    """Return the physics module that is not beside the robot's file, if there is none there."""
    file = project.misplaced_physics
    if file is None:
        return []
    text = f"pyfrc does not read this file: {file.name} belongs beside {project.main_file.name}"
    return [CodeWarning(project.shown(file), text, f"Move it to {project.root}.")]
