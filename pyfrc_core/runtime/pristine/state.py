"""The state of a process before its first run, of all kinds of things."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress

from ...compat.unrepeatable import forget_all_noise
from ...processes.exit import before_sudden_exit
from ...project.robot_files import RobotFiles
from .. import turns
from ..exceptions import TestEnded, TestFroze
from ..patches import data_logs
from ..patches.active_run import active_run
from ..patches.object_hashes import restart_numbers
from ..threads import cooperative
from .left_behind import Devices, ProjectObjects, ScheduledCommands, Tables, Threads
from .modules import ProjectModules
from .part import StatePart
from .process import Directory, EnvironmentVariables, Logging, Randomness, Signals, Streams
from .replaced_names import ReplacedNames

#: How many reasons are given.
_NAMED = 3

#: What Python keeps of the last exception.
_LAST_ERROR = ("last_exc", "last_type", "last_value", "last_traceback")

#: Each robot that is constructed leaves a subscription in WPILib's NetworkTables, which have room for 512.
_MOST_RUNS = 500


class LastRun(StatePart):
    """The run, which is ended and closed."""

    def __init__(self) -> None:
        self._runs = 0

    def restore(self) -> None:
        run = active_run.run
        self._runs += 1
        if run is not None:
            with suppress(Exception, TestEnded, TestFroze):  # which its user has seen, if it is of any interest
                run.close()
        before_sudden_exit.clear()
        data_logs.started_at_import.clear()
        cooperative.scope.waiting_to_begin.clear()
        forget_all_noise()
        restart_numbers()
        turns.release()
        for name in _LAST_ERROR:
            vars(sys).pop(name, None)

    def left_over(self) -> Iterator[str]:
        if active_run.run is not None:
            yield "a robot that cannot be ended"
        if self._runs >= _MOST_RUNS:
            yield f"a subscription to NetworkTables, as each of {_MOST_RUNS} robots before"


class ProcessState:
    """The state of this process now.

    :param files: those of the project
    :param forget: called after each run: what the user of this has kept of the project
    """

    def __init__(self, files: RobotFiles, forget: Iterable[Callable[[], object]] = ()) -> None:
        self._forget = list(forget)
        modules = ProjectModules(files)
        #: In the order in which they are put back.
        self._parts: list[StatePart] = [
            LastRun(),
            Tables(),  # before the scheduler, which a dashboard may show
            ScheduledCommands(),
            Streams(),
            Directory(),
            EnvironmentVariables(),
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
