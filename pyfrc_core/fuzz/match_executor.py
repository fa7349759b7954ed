"""Run matches in worker processes: forks of a process that has imported everything, or new interpreters.

Each match has its own process, so it may crash, hang and print without harm.
"""

from __future__ import annotations

import tempfile
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ..errors import RobotCodeError
from ..interruption import calling_when_ended
from ..processes.call import ForkedCall, can_fork, run_in_subprocess
from ..processes.crash_report import CrashLog
from ..processes.fork import wait_for_any
from ..project import Project
from ..runtime.clock import to_us
from ..runtime.fork_obstacles import reasons_not_to_fork
from ..runtime.scripts.script import InputScript
from ..runtime.turns import taking_turns
from .boots import MEANWHILE
from .failure import HANGS, PROCESS_ENDED, FuzzFailure
from .goals import Line
from .imported_robot import robot_lines
from .journal import read_journal
from .match import (
    ROBOT_SEED,
    FuzzTask,
    MatchResult,
    ReplayTask,
    Task,
    match_seconds,
    play,
)
from .preparation import Preparation

Answer = TypeVar("Answer")

# Interval of the checks for an interrupt, in seconds.
_INTERRUPT_CHECK_SECONDS = 0.1


class MatchExecutor(ABC):
    """Runs matches of one project.

    :param jobs: how many at a time
    :param directory: a directory for temporary files
    """

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        self.project = project
        self.jobs = jobs
        #: Set to end the matches: `play` then raises `KeyboardInterrupt`. (An exception raised by a signal handler
        #: would be lost if it came during a fork.)
        self.interrupted = False
        self._directory = directory
        self._journals = 0

    @property
    @abstractmethod
    def lines(self) -> frozenset[Line]:
        """Return the lines of the robot's functions."""

    @abstractmethod
    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        """Return the results in the order of the tasks, each as soon as it is known; closing the generator ends the
        remaining tasks.
        """

    def replay(self, script: InputScript) -> MatchResult:
        """Run the robot with the inputs of a script."""
        (played,) = self.play([ReplayTask(script)])
        return played

    def interruptible(self) -> AbstractContextManager[None]:
        """Interrupt the matches on Ctrl-C, and when the terminal is closed, until the context ends."""

        def interrupt() -> None:
            self.interrupted = True

        return calling_when_ended(interrupt)

    def _check_interrupt(self) -> None:
        if self.interrupted:
            raise KeyboardInterrupt

    @contextmanager
    def _journal(self, task: Task) -> Iterator[None]:
        """Delete the task's journal when the context ends."""
        try:
            yield
        finally:
            if isinstance(task, FuzzTask) and task.journal is not None:
                task.journal.unlink(missing_ok=True)

    def _with_journal(self, task: Task) -> Task:
        if isinstance(task, ReplayTask):
            return task
        self._journals += 1
        return replace(task, journal=self._directory / str(self._journals))

    def _died(self, task: Task, text: str) -> MatchResult:
        """Return the result of a match whose process ended without returning one."""
        headline = text.partition("\n")[0]
        place, _, what = headline.partition(": ")
        if not what:
            place = ""
        failure = FuzzFailure(HANGS if " hangs here" in headline else PROCESS_ENDED, place, "", headline)
        if isinstance(task, ReplayTask):
            return MatchResult(failure, task.script)
        steps = tuple(read_journal(task.journal)) if task.journal is not None else ()
        end_us = to_us(match_seconds(self.project, task.schedule))
        return MatchResult(failure, InputScript(steps, end_us, robot=self.project.main_file.name, seed=ROBOT_SEED))


@contextmanager
def open_match_executor(project: Project, jobs: int) -> Iterator[MatchExecutor]:
    """Open the executor that fits this project and platform.

    :raises RobotCodeError: when the robot's code cannot be imported
    """
    with tempfile.TemporaryDirectory(prefix="pyfrc-fuzz-") as temporary, taking_turns():
        if not can_fork(project):
            yield SpawnedMatchExecutor(project, jobs, Path(temporary))
            return
        with closing(ForkedMatchExecutor(project, jobs, Path(temporary))) as executor:
            yield executor


class PooledMatchExecutor(MatchExecutor):
    """Runs matches in an executor of `concurrent.futures`."""

    @property
    def lines(self) -> frozenset[Line]:
        return run_in_subprocess(_all_lines, self.project, "while it was imported")

    @abstractmethod
    def _pool(self) -> AbstractContextManager[Executor]:
        """Return the executor, which is used until the context ends."""

    @abstractmethod
    def _call(self, task: Task) -> Callable[[], Any]:
        """Return the function that plays a task there."""

    @abstractmethod
    def _match_result(self, task: Task, future: Future[Any]) -> MatchResult:
        """Return the result of the match whose future is done."""

    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        with self._pool() as pool:
            waiting: deque[tuple[Task, Future[Any]]] = deque()
            try:
                for task in map(self._with_journal, tasks):
                    waiting.append((task, pool.submit(self._call(task))))
                    while sum(not future.done() for _, future in waiting) >= self.jobs:
                        yield self._result(*waiting.popleft())
                while waiting:
                    yield self._result(*waiting.popleft())
            finally:
                for _, future in waiting:
                    future.cancel()

    def _result(self, task: Task, future: Future[Any]) -> MatchResult:
        with self._journal(task):
            while not future.done():
                wait([future], _INTERRUPT_CHECK_SECONDS)
                self._check_interrupt()
            self._check_interrupt()  # the signal may have ended that process, too
            return self._match_result(task, future)


class SpawnedMatchExecutor(PooledMatchExecutor):
    """Runs each match in a new interpreter."""

    def _pool(self) -> AbstractContextManager[Executor]:
        return ThreadPoolExecutor(self.jobs)

    def _call(self, task: Task) -> Callable[[], MatchResult]:
        return partial(run_in_subprocess, partial(play, task=task), self.project, MEANWHILE)

    def _match_result(self, task: Task, future: Future[MatchResult]) -> MatchResult:
        try:
            return future.result()
        except RobotCodeError as ended:
            return self._died(task, str(ended))


def _all_lines(project: Project, log: CrashLog) -> frozenset[Line]:
    return robot_lines(project).all()


class ForkedMatchExecutor(MatchExecutor):
    """Runs each match in a fork of this process, which has imported the robot, unless importing it starts threads."""

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        super().__init__(project, jobs, directory)
        self._running: list[ForkedCall[MatchResult]] = []

        def survey() -> tuple[bool, frozenset[Line]]:
            lines = robot_lines(project).all()
            return bool(reasons_not_to_fork()), lines

        # In a separate process first: an import cannot be undone.
        imports_late, self._lines = self._do(survey)
        self._preparation = Preparation(project, is_imported=not imports_late)

    @property
    def lines(self) -> frozenset[Line]:
        return self._lines

    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        waiting: deque[tuple[Task, ForkedCall[MatchResult]]] = deque()
        left = map(self._with_journal, tasks)
        try:
            more = True
            while more or waiting:
                self._check_interrupt()
                # First, since the caller may close the generator then: a shorter script has failed.
                if waiting and waiting[0][1].finished:
                    yield self._result(*waiting.popleft())
                    continue
                while more and sum(not work.finished for _, work in waiting) < self.jobs:
                    task = next(left, None)
                    if task is None:
                        more = False
                    else:
                        waiting.append((task, self._begin(task)))
                if going_on := [work for _, work in waiting if not work.finished]:
                    wait_for_any([work.fileno() for work in going_on])
                    for work in going_on:
                        work.poll()
        finally:
            for _, work in waiting:
                work.close()
                self._running.remove(work)

    def close(self) -> None:
        """End the matches that are still running."""
        for work in self._running:
            work.close()
        self._preparation.close()

    def _begin(self, task: Task) -> ForkedCall[MatchResult]:
        self._preparation.prepare_for(task)
        work = ForkedCall(lambda log: play(self.project, log, task), files=self.project.files)
        self._running.append(work)
        return work

    def _result(self, task: Task, work: ForkedCall[MatchResult]) -> MatchResult:
        self._running.remove(work)
        with self._journal(task), closing(work):
            try:
                return work.result(self.project.files, MEANWHILE)
            except RobotCodeError as ended:
                return self._died(task, str(ended))

    def _do(self, what: Callable[[], Answer]) -> Answer:
        work = ForkedCall(lambda log: what(), files=self.project.files)
        with closing(work):
            work.wait()
            return work.result(self.project.files, "while it was imported")
