"""Makes a script short in a new process: one in which a robot has run can no longer be forked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from ..errors import PyfrcError
from ..processes.call import can_fork, run_in_subprocess
from ..processes.crash_report import CrashLog
from ..project import Project
from ..runtime.hang_detector import not_watched
from ..runtime.scripts.script import InputScript
from .describe import story_of
from .failure import FuzzFailure
from .inputs import Input
from .match_executor import open_match_executor
from .shrink import Shrinker


@dataclass(frozen=True)
class Shrunk:
    """What came of it.

    :param script: the shortest that fails in the same way; None when there is none
    :param story: what happens in it, and the failure
    :param why_not: why there is none, as the end of a sentence
    """

    script: InputScript | None
    story: tuple[str, ...] = ()
    why_not: str = ""


def shrink_in_subprocess(
    project: Project, script: InputScript, failure: FuzzFailure, inputs: Mapping[str, Input], most_runs: int
) -> Shrunk:
    """Make a script short, which has made a robot raise something in this process.

    :param most_runs: how many robots to run
    """
    if not can_fork(project):
        return Shrunk(None, why_not="making it short takes hundreds of processes, and they cannot be forked here")
    work = partial(_shrink, script=script, failure=failure, inputs=dict(inputs), most_runs=most_runs)
    try:
        with not_watched():
            return run_in_subprocess(work, project, "while a script was made shorter")
    except PyfrcError as wrong:
        return Shrunk(None, why_not=f"it could not be made short ({wrong})")


def _shrink(
    project: Project,
    log: CrashLog,
    script: InputScript,
    failure: FuzzFailure,
    inputs: dict[str, Input],
    most_runs: int,
) -> Shrunk:
    # One at a time: other tests are run beside this one.
    with open_match_executor(project, jobs=1) as executor:
        shrinker = Shrinker(executor, script, failure, inputs, most_runs, use_oracle=False)
        shrinker.shrink()
        if not shrinker.repeats or not shrinker.play_again():
            return Shrunk(None, why_not="the robot did not fail in the same way again")
        return Shrunk(shrinker.script, story_of(shrinker.script, shrinker.failure))
