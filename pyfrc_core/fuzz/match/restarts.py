"""Play a match in which the robot program is started again: each part in its own process.

A program cannot be started twice in one process: its modules, and WPILib's, keep what the first part has set. What a
part leaves to the next one is sent between the processes.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from functools import partial

from ...processes.call import ForkedCall, run_in_subprocess
from ...processes.crash_report import CrashLog
from ...processes.fork import is_forked
from ...project import Project
from .work import MatchResult

#: When robot code ends its process.
MEANWHILE = "in the middle of the match"


def play_parts(project: Project, play_part: Callable[..., MatchResult], quietly: bool = True) -> MatchResult:
    """Play one part after the other, each in another process, and return the result of the last one.

    :param play_part: plays one part in its process, with the result of the parts before as `before`; can be pickled
    :param quietly: whether nothing that they print is shown
    :raises RobotCodeError: when a process ends without a result
    """
    played: MatchResult | None = None
    while played is None or played.restart is not None:
        played = _call(project, partial(play_part, before=played), quietly)
    return played


def _call(project: Project, work: Callable[[Project, CrashLog], MatchResult], quietly: bool) -> MatchResult:
    if not is_forked(project.isolation):
        return run_in_subprocess(work, project, MEANWHILE, quietly)
    call = ForkedCall(partial(work, project), quietly)
    with closing(call):
        call.wait()
        return call.result(project.files, MEANWHILE)
