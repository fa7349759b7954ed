"""The state of a process before its first run, of all kinds of things."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator, Sequence

from ...project.robot_files import RobotFiles
from ..exceptions import TestEnded, TestFroze
from .last_run import LastRun
from .left_behind import Commands, Devices, ProjectObjects, Tables, Threads
from .modules import ProjectModules
from .part import Part
from .process import Directory, Environment, Logging, Randomness, Signals, Streams
from .replaced_names import ReplacedNames

#: How many reasons are given.
_NAMED = 3


class ProcessState:
    """The state of this process now.

    :param files: those of the project
    :param forget: called after each run: what the user of this has kept of the project
    """

    def __init__(self, files: RobotFiles, forget: Iterable[Callable[[], object]] = ()) -> None:
        self._forget = list(forget)
        modules = ProjectModules(files)
        #: In the order in which they are put back.
        self._parts: list[Part] = [
            LastRun(),
            Tables(),  # before the scheduler, which a dashboard may show
            Commands(),
            Streams(),
            Directory(),
            Environment(),
            Signals(),
            Logging(),
            ReplacedNames(modules),
            modules,
            Randomness(),
            Threads(),
            ProjectObjects(modules),
            Devices(),
        ]
        gc.freeze()  # a collection then looks only at what a run has made

    def restore(self) -> Sequence[str]:
        """Put the process back into this state; return what is left that could not be put back."""
        left: list[str] = []
        for call in (*self._forget, *(part.restore for part in self._parts)):
            try:
                call()
            except (Exception, TestEnded, TestFroze) as error:
                left.append(f"something that raises {error!r} when it is put back")
        gc.collect()
        left += self.left_over()
        if not left:
            gc.freeze()
        return left[:_NAMED]

    def left_over(self) -> Iterator[str]:
        """Yield what differs now from this state."""
        for part in self._parts:
            yield from part.left_over()
