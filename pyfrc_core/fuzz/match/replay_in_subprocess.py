"""Replay a script in a new process: a script with restarts of the robot program needs a process for each boot."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from ...errors import RobotCodeError
from ...processes.call import run_in_subprocess
from ...project import Project
from ...runtime.checks.hang_detector import not_watched
from ...runtime.clock import PACKET_US
from ...runtime.scripts.script import InputScript
from .play import play
from .restarts import MEANWHILE
from .work import ReplayTask


def replay_in_subprocess(
    project: Project, script: InputScript, trace: Path | None = None, quietly: bool = True
) -> tuple[float, RobotCodeError | None]:
    """Run the robot with the inputs of a script; return how far it came, in seconds, and how it failed.

    In a script that fuzzing has saved, misbehavior without an exception is a failure, too.

    :param trace: where to write the trace of the last boot
    :param quietly: whether nothing that the robot prints is shown
    :raises RobotCodeError: when the robot cannot be imported, or ends its process
    :raises ScriptError: when something cannot be written, or the robot has no such device
    """
    task = ReplayTask(script, bool(script.story), trace=trace, ignores_missing=False, quietly=quietly, paced=True)
    with not_watched():
        played = run_in_subprocess(partial(play, task=task), project, MEANWHILE, quietly)
    failed = [each for each in played.each_failure() if each.failure is not None]
    if not failed:
        return script.end_us / 1_000_000, None
    last = failed[-1]
    assert last.failure is not None
    return (last.script.end_us - PACKET_US) / 1_000_000, RobotCodeError(last.failure.text)
