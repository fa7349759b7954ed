"""Prepare matches in an interpreter that plays one after the other: what fuzz keeps of a project between them."""

from __future__ import annotations

from functools import lru_cache

from ...processes.interpreter import InitialState
from ...project import Project


@lru_cache(maxsize=1)
def known_project(project: Project) -> Project:
    """Return the project with the same files that this process knows already, and whose settings it has read."""
    return project


def prepare_interpreter(project: Project) -> InitialState:
    """Import what each match needs; return the state in which each is to begin."""
    from ...patch_table import PatchTable
    from ...runtime.as_good_as_new.state import ProcessState
    from ...runtime.patches.install import patches
    from ...wpi import network
    from ..inputs.finders import prepare_search
    from . import imported_robot, play  # noqa: F401

    known_project(project)
    patches.install(project.files)
    prepare_search()
    # It would start a thread, and no one reads what matches log.
    PatchTable().patch(*network.NETWORK_LOG.place, lambda instance: None)
    return ProcessState(project.files, forget=[imported_robot.forget])
