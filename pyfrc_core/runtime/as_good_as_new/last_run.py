"""The run of the robot, and what pyfrc itself keeps of it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import suppress

from ...compat.unrepeatable import forget_all_noise
from ...processes.exit import before_sudden_exit
from ..exceptions import TestEnded, TestFroze
from ..patches import data_logs
from ..patches.active_run import active_run
from ..patches.object_hashes import restart_numbers
from ..threads import cooperative
from ..turns import give_back
from .part import Part

#: What Python keeps of the last exception.
_LAST_ERROR = ("last_exc", "last_type", "last_value", "last_traceback")

#: Each robot that is constructed leaves a subscription in WPILib's NetworkTables, which have room for 512.
_MOST_RUNS = 500


class LastRun(Part):
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
        give_back()
        for name in _LAST_ERROR:
            vars(sys).pop(name, None)

    def left_over(self) -> Iterator[str]:
        if active_run.run is not None:
            yield "a robot that cannot be ended"
        if self._runs >= _MOST_RUNS:
            yield f"a subscription to NetworkTables, as each of {_MOST_RUNS} robots before"
