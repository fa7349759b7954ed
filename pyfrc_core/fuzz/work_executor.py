"""Executors: what runs matches, and shrinks scripts beside them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import replace
from pathlib import Path

from ..interruption import calling_when_ended
from ..project import Project
from ..runtime.clock import to_us
from ..runtime.scripts.script import InputScript
from .failure import HANGS, PROCESS_ENDED, FuzzFailure
from .goals import Line
from .journal import read_journal
from .match import ROBOT_SEED, FuzzTask, MatchResult, ReplayTask, Task, match_seconds
from .shrink_task import ShrinkTask, Shrunk

#: What an executor can do, and what comes of it.
Work = Task | ShrinkTask
Result = MatchResult | Shrunk
#: Returns what to begin now; None to wait for what is running; raises `NoMoreWork`.
NextWork = Callable[[], Work | None]


class NoMoreWork(Exception):
    """Ends what is running, without its result."""


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


class WorkExecutor(MatchExecutor):
    """Runs matches of one project, and shrinks scripts beside them.

    :param directory: a directory for temporary files
    """

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        super().__init__(project, jobs, directory)
        self._journals = 0

    @abstractmethod
    def run(self, next_work: NextWork) -> Generator[tuple[Work, Result], None, None]:
        """Begin what `next_work` returns until it returns None, and yield each result as soon as it is known.

        It is called again after each result, and several times a second. The generator ends when nothing is begun and
        nothing is running; closing it ends what is running.
        """

    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        left, running, found = enumerate(tasks), dict[int, Task](), dict[int, MatchResult]()

        def next_work() -> Task | None:
            begun = next(left, None) if len(running) < self.jobs else None
            if begun is None:
                return None
            running[begun[0]] = begun[1]
            return begun[1]

        next_index = 0
        with closing(self.run(next_work)) as results:
            for task, result in results:
                assert isinstance(result, MatchResult)
                index = next(index for index, each in running.items() if each is task)
                del running[index]
                found[index] = result
                # At once, since the caller may close the generator then: a shorter script has failed.
                while next_index in found:
                    yield found.pop(next_index)
                    next_index += 1

    def interruptible(self) -> AbstractContextManager[None]:
        """Interrupt the matches on Ctrl-C, and when the terminal is closed, until the context ends."""

        def interrupt() -> None:
            self.interrupted = True

        return calling_when_ended(interrupt)

    def _check_interrupt(self) -> None:
        if self.interrupted:
            raise KeyboardInterrupt

    @contextmanager
    def _journal(self, task: Work) -> Iterator[None]:
        """Delete the task's journal when the context ends."""
        try:
            yield
        finally:
            if isinstance(task, FuzzTask) and task.journal is not None:
                task.journal.unlink(missing_ok=True)

    def _with_journal(self, task: Work) -> Work:
        if not isinstance(task, FuzzTask):
            return task
        self._journals += 1
        return replace(task, journal=self._directory / str(self._journals))

    def _died(self, task: Work, text: str) -> Result:
        """Return the result of a match whose process ended without returning one."""
        if isinstance(task, ShrinkTask):
            return Shrunk(task.script, task.failure)
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
