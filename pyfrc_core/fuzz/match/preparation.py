"""Prepare matches in the process from which theirs are forked.

What each match would make in the same way, or read from the disk, is made here once; a fork finds it.
"""

from __future__ import annotations

import gc
import linecache
from contextlib import suppress

from ...errors import PyfrcError
from ...hal import HalData, devices_exist
from ...project import Project
from ...runtime.module_files import resolve_module_files
from ...runtime.patch_table import PatchTable
from ...wpi import network
from ..inputs.asked_controls import prepare_control_watch
from ..inputs.finders import prepare_search
from ..inputs.network_reads import prepare_network_watch
from ..oracle.motor_calls import prepare_motor_watch
from .imported_robot import auto_joysticks, game_messages, imported_devices, next_tree, robot_constants, robot_lines
from .work import FuzzTask, ReplayTask


class Preparation:
    """What the forks of this process find prepared.

    :param is_imported: whether the robot may be imported in this process
    """

    def __init__(self, project: Project, is_imported: bool) -> None:
        self._project = project
        self._is_imported = is_imported
        self._patches = PatchTable()
        if is_imported:
            lines = robot_lines(project)
            robot_constants(project)
            imported_devices(project)
            resolve_module_files()
            for file in {function.__code__.co_filename for function in lines.functions}:
                linecache.getlines(file)  # WPILib asks for the lines that create a device
        devices_exist()
        prepare_search()
        _build(next_tree())
        _read_settings(project)
        # It would start a thread, and no one reads what matches log.
        self._patches.patch(*network.NETWORK_LOG.place, lambda instance: None)
        gc.freeze()  # a garbage collection in a fork would copy the memory of all objects

    def prepare_for(self, task: object) -> None:
        """Prepare what watches calls in this task, and nothing else: a replay runs as without fuzz."""
        is_match = isinstance(task, FuzzTask)
        self._watch(is_match, is_match or (isinstance(task, ReplayTask) and task.use_oracle))

    def _watch(self, drivers: bool, motors: bool) -> None:
        prepare_control_watch(self._is_imported and drivers)
        prepare_network_watch(self._project.files, self._is_imported and drivers)
        prepare_motor_watch(self._is_imported and motors)

    def close(self) -> None:
        """Undo what would be noticed in this process."""
        self._watch(drivers=False, motors=False)
        self._patches.undo()


def _build(tree: HalData) -> None:
    """Build the parts of the tree that every match uses: they are built when they are first used."""
    for branch in ("control", "event", "time", "power", "accelerometer", "CAN"):
        dict(tree[branch])
    for stick in tree["joysticks"]:
        dict(stick)


def _read_settings(project: Project) -> None:
    """Read ``sim/config.json``, and warn here of keys without effect: a match prints nothing.

    What is wrong in it is a matter of the robot's run.
    """
    with suppress(PyfrcError):
        game_messages(project)
        auto_joysticks(project)
