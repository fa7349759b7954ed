"""Run matches in worker processes: forks of a process that has imported everything, or new interpreters.

Each match has its own process, so it may crash, hang and print without harm.
"""

from __future__ import annotations

import tempfile
from abc import abstractmethod
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ..errors import RobotCodeError
from ..processes.call import ForkedCall, can_fork, run_in_subprocess
from ..processes.crash_report import CrashLog
from ..processes.fork import wait_for_any
from ..project import Project
from ..runtime.threads.fork_obstacles import reasons_not_to_fork
from ..runtime.turns import taking_turns
from .boots import MEANWHILE
from .goals import Line
from .imported_robot import robot_lines
from .match import play
from .preparation import Preparation
from .shrink import Shrinker
from .shrink_task import ShrinkTask, Shrunk
from .work_executor import NextWork, NoMoreWork, Result, Work, WorkExecutor

Answer = TypeVar("Answer")

# Interval of the checks for an interrupt and for the end of the campaign's time, in seconds.
_INTERRUPT_CHECK_SECONDS = 0.1


@contextmanager
def open_match_executor(project: Project, jobs: int) -> Iterator[WorkExecutor]:
    """Open the executor that fits this project and platform.

    :raises RobotCodeError: when the robot's code cannot be imported
    """
    with tempfile.TemporaryDirectory(prefix="pyfrc-fuzz-") as temporary, taking_turns():
        if not can_fork(project):
            yield SpawnedMatchExecutor(project, jobs, Path(temporary))
            return
        with closing(ForkedMatchExecutor(project, jobs, Path(temporary))) as executor:
            yield executor


class PooledMatchExecutor(WorkExecutor):
    """Runs matches in an executor of `concurrent.futures`."""

    @property
    def lines(self) -> frozenset[Line]:
        return run_in_subprocess(_all_lines, self.project, "while it was imported")

    @abstractmethod
    def _pool(self) -> AbstractContextManager[Executor]:
        """Return the executor, which is used until the context ends."""

    @abstractmethod
    def _call(self, task: Work) -> Callable[[], Any]:
        """Return the function that does a task there."""

    @abstractmethod
    def _result_of(self, task: Work, future: Future[Any]) -> Result:
        """Return the result of the task whose future is done."""

    def run(self, next_work: NextWork) -> Generator[tuple[Work, Result], None, None]:
        running: dict[Future[Any], tuple[Work, Work]] = {}
        with self._pool() as pool:
            try:
                while True:
                    while (task := next_work()) is not None:
                        noted = self._with_journal(task)
                        running[pool.submit(self._call(noted))] = task, noted
                    if not running:
                        return
                    done, _ = wait(running, _INTERRUPT_CHECK_SECONDS, FIRST_COMPLETED)
                    self._check_interrupt()  # the signal may have ended that process, too
                    for future in done:
                        task, noted = running.pop(future)
                        with self._journal(noted):
                            result = self._result_of(noted, future)
                        yield task, result
            except NoMoreWork:
                return
            finally:
                for future in running:
                    future.cancel()


class SpawnedMatchExecutor(PooledMatchExecutor):
    """Runs each match in a new interpreter."""

    def _pool(self) -> AbstractContextManager[Executor]:
        return ThreadPoolExecutor(self.jobs + 1)  # one more shrinks

    def _call(self, task: Work) -> Callable[[], Result]:
        return partial(run_in_subprocess, partial(_work, work=task), self.project, MEANWHILE)

    def _result_of(self, task: Work, future: Future[Result]) -> Result:
        try:
            return future.result()
        except RobotCodeError as ended:
            return self._died(task, str(ended))


def _work(project: Project, log: CrashLog, work: Work) -> Result:
    """Do one task in this process, which must end afterwards."""
    if isinstance(work, ShrinkTask):
        return shrink_alone(project, work)
    return play(project, log, work)


def _all_lines(project: Project, log: CrashLog) -> frozenset[Line]:
    return robot_lines(project).all()


class ForkedMatchExecutor(WorkExecutor):
    """Runs each match in a fork of this process, which has imported the robot, unless importing it starts threads."""

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        super().__init__(project, jobs, directory)

        def survey() -> tuple[bool, frozenset[Line]]:
            lines = robot_lines(project).all()
            return bool(reasons_not_to_fork()), lines

        # In a separate process first: an import cannot be undone.
        imports_late, self._lines = self._do(survey)
        self._preparation = Preparation(project, is_imported=not imports_late)

    @property
    def lines(self) -> frozenset[Line]:
        return self._lines

    def run(self, next_work: NextWork) -> Generator[tuple[Work, Result], None, None]:
        running: dict[ForkedCall[Result], tuple[Work, Work]] = {}
        try:
            while True:
                self._check_interrupt()
                while (task := next_work()) is not None:
                    noted = self._with_journal(task)
                    running[self._begin(noted)] = task, noted
                if not running:
                    return
                wait_for_any([call.fileno() for call in running])
                for call in list(running):
                    call.poll()
                    if call.finished:
                        task, noted = running.pop(call)
                        yield task, self._result(noted, call)
        except NoMoreWork:
            return
        finally:
            for call in running:
                call.close()

    def close(self) -> None:
        """Undo what is prepared in this process."""
        self._preparation.close()

    def _begin(self, task: Work) -> ForkedCall[Result]:
        self._preparation.prepare_for(task)
        return ForkedCall(lambda log: _work(self.project, log, task), files=self.project.files)

    def _result(self, task: Work, call: ForkedCall[Result]) -> Result:
        with self._journal(task), closing(call):
            try:
                return call.result(self.project.files, MEANWHILE)
            except RobotCodeError as ended:
                return self._died(task, str(ended))

    def _do(self, what: Callable[[], Answer]) -> Answer:
        work = ForkedCall(lambda log: what(), files=self.project.files)
        with closing(work):
            work.wait()
            return work.result(self.project.files, "while it was imported")


def shrink_alone(project: Project, task: ShrinkTask) -> Shrunk:
    """Make a script short in this process, which has run no robot, one run at a time."""
    options = task.most_runs, task.use_oracle, task.seconds
    with open_match_executor(project, jobs=1) as executor:
        shrinker = Shrinker(executor, task.script, task.failure, task.inputs, *options)
        shrinker.shrink()
        if shrinker.repeats and shrinker.play_again():
            return Shrunk(shrinker.script, shrinker.failure, True, shrinker.runs)
        return Shrunk(task.script, task.failure, runs=shrinker.runs)
