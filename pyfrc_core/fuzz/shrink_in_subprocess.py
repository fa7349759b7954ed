"""Makes a script short in a new process: one in which a robot has run can no longer be forked."""

from __future__ import annotations

from functools import partial

from ..errors import PyfrcError
from ..processes.call import can_fork, run_in_subprocess
from ..processes.crash_report import CrashLog
from ..project import Project
from ..runtime.checks.hang_detector import not_watched
from .match_executor import shrink_alone
from .shrink_task import ShrinkTask, Shrunk


def shrink_in_subprocess(project: Project, task: ShrinkTask) -> Shrunk | str:
    """Make a script short, which has made a robot raise something in this process.

    :returns: what came of it, or the end of a sentence that says why there is no shorter script
    """
    if not can_fork(project):
        return "making it short takes hundreds of processes, and they cannot be forked here"
    try:
        with not_watched():
            shrunk: Shrunk = run_in_subprocess(partial(_shrink, task=task), project, "while a script was made shorter")
    except PyfrcError as wrong:
        return f"it could not be made short ({wrong})"
    return shrunk if shrunk.repeats else "the robot did not fail in the same way again"


def _shrink(project: Project, log: CrashLog, task: ShrinkTask) -> Shrunk:
    return shrink_alone(project, task)
