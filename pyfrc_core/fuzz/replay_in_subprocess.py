"""Replay a script in a new process: a script with restarts of the robot program needs a process for each boot."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from ..errors import RobotCodeError
from ..processes.call import run_in_subprocess
from ..project import Project
from ..runtime.scripts.script import InputScript
from .boots import MEANWHILE
from .match import ReplayTask, play


def replay_in_subprocess(project: Project, script: InputScript, trace: Path | None = None) -> None:
    """Run the robot with the inputs of a script.

    In a script that fuzzing has saved, misbehavior without an exception is a failure, too.

    :param trace: where to write the trace of the last boot
    :raises RobotCodeError: when the robot fails, naming the user's line
    :raises ScriptError: when something cannot be written, or the robot has no such device
    """
    task = ReplayTask(script, use_oracle=bool(script.story), trace=trace, ignores_missing=False)
    played = run_in_subprocess(partial(play, task=task), project, MEANWHILE)
    failures = [each.failure for each in played.each_failure() if each.failure is not None]
    if failures:
        raise RobotCodeError(failures[-1].text)
