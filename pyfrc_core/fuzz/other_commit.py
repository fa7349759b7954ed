"""Play matches with the robot's code of another commit, in another process: one process cannot import both."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from functools import partial
from multiprocessing.connection import Pipe

from ..processes.call import ForkedCall, can_fork, run_in_subprocess
from ..processes.crash_report import CrashLog
from ..project import Project
from .match import MatchResult, ReplayTask
from .match_executor import open_match_executor

_MEANWHILE = "in the other commit"

#: Plays matches, and returns their results in order.
Play = Callable[[Sequence[ReplayTask]], list[MatchResult]]


@contextmanager
def open_other_commit(project: Project, jobs: int) -> Iterator[tuple[Play, bool]]:
    """Return what plays matches with the code of another commit, and whether it is ready at once for each call.

    Open it before this process imports the robot: a fork then imports the other code, once. Where processes cannot be
    forked, each call starts a new interpreter. Calls raise `RobotCodeError` when the other code cannot be imported.

    :param project: the project as it was
    :param jobs: how many matches to run at a time
    """
    if not can_fork(project):
        yield lambda tasks: run_in_subprocess(partial(_play_all, tasks=tasks, jobs=jobs), project, _MEANWHILE), False
        return
    with closing(_ForkedCommit(project, jobs)) as other:
        yield other.play, True


class _ForkedCommit:
    """A fork of this process that has imported the code of the other commit."""

    def __init__(self, project: Project, jobs: int) -> None:
        self._project = project
        self._connection, other_end = Pipe()

        def serve(log: CrashLog) -> None:
            self._connection.close()
            with open_match_executor(project, jobs) as executor, suppress(EOFError):
                while (tasks := other_end.recv()) is not None:
                    other_end.send(list(executor.play(tasks)))

        self._call = ForkedCall(serve)
        other_end.close()

    def play(self, tasks: Sequence[ReplayTask]) -> list[MatchResult]:
        """Play these matches.

        :raises RobotCodeError: when the code of the other commit cannot be imported
        """
        with suppress(EOFError, OSError):
            self._connection.send(tasks)
            results: list[MatchResult] = self._connection.recv()
            return results
        self._call.wait()
        self._call.result(self._project.files, _MEANWHILE)
        raise AssertionError("the process has ended without an error")

    def close(self) -> None:
        """End the process, and remove its temporary files."""
        with suppress(OSError):  # it has ended
            self._connection.send(None)  # a process that robot code has left behind may hold the connection open
        self._connection.close()
        self._call.wait()
        self._call.close()


def _play_all(project: Project, log: CrashLog, tasks: Sequence[ReplayTask], jobs: int) -> list[MatchResult]:
    with open_match_executor(project, jobs) as executor:
        return list(executor.play(tasks))
