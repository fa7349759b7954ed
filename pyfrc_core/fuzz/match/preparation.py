"""Prepare matches in the process from which theirs are forked, or in an interpreter that plays one after the other.

What each match would make in the same way, or read from the disk, is made here once.
"""

from __future__ import annotations

import gc
from collections.abc import Sequence
from contextlib import suppress
from functools import lru_cache

from ...errors import PyfrcError
from ...patch_table import PatchTable
from ...processes.interpreter import InitialState
from ...project import Project
from ...wpi import network
from ..inputs.finders import prepare_search
from .imported_robot import import_libraries, imported_devices, robot_constants


class Preparation:
    """What the forks of this process find prepared.

    :param is_imported: whether the robot may be imported in this process
    :param libraries: the modules to import here if it may not: most of the time of an import is theirs
    """

    def __init__(self, project: Project, is_imported: bool, libraries: Sequence[str] = ()) -> None:
        self._patches = PatchTable()
        if is_imported:
            robot_constants(project)
            imported_devices(project)
        elif libraries:
            import_libraries(project, libraries)
        prepare_search()
        _read_settings(project)
        # It would start a thread, and no one reads what matches log.
        self._patches.patch(*network.NETWORK_LOG.place, lambda instance: None)
        gc.freeze()  # a garbage collection in a fork would copy the memory of all objects

    def close(self) -> None:
        """Undo what would be noticed in this process."""
        self._patches.undo()


def _read_settings(project: Project) -> None:
    """Read ``sim/config.json``, and warn here of keys without effect: a match prints nothing.

    What is wrong in it is a matter of the robot's run.
    """
    with suppress(PyfrcError):
        _ = project.game_specific_messages


@lru_cache(maxsize=1)
def known_project(project: Project) -> Project:
    """Return the project with the same files that this process knows already, and whose settings it has read."""
    return project


def prepare_interpreter(project: Project) -> InitialState:
    """Import what each match needs; return the state in which each is to begin."""
    from ...runtime.patches.install import patches
    from ...runtime.pristine.state import ProcessState
    from . import imported_robot, play  # noqa: F401

    known_project(project)
    patches.install(project.files)
    prepare_search()
    # It would start a thread, and no one reads what matches log.
    PatchTable().patch(*network.NETWORK_LOG.place, lambda instance: None)
    return ProcessState(project.files, forget=[imported_robot.forget])
