"""Run matches in worker processes: forks of a process that has imported everything, or new interpreters.

Each match has its own process, so it may crash, hang and print without harm.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from ...errors import PyfrcError, RobotCodeError
from ...interruption import interruption
from ...processes.call import Call, ForkedCall, begin_call, run_in_subprocess, wait_for_calls
from ...processes.crash_report import CrashLog
from ...processes.fork import is_forked
from ...processes.reuse import Interpreters
from ...project import Project
from ...runtime.checks.hang_detector import not_watched
from ...runtime.clock import to_us
from ...runtime.scripts.script import InputScript
from ...runtime.threads.fork_obstacles import reasons_not_to_fork
from ...runtime.turns import taking_turns
from ...temporary import temporary_directory
from ..guidance.goals import RobotLine
from ..guidance.seed_schedule import match_seconds
from ..match.imported_robot import import_libraries, libraries_of, robot_lines
from ..match.journal import read_journal
from ..match.play import play
from ..match.preparation import Preparation, known_project, prepare_interpreter
from ..match.restarts import MEANWHILE
from ..match.work import (
    FuzzTask,
    MatchExecutor,
    MatchResult,
    NextWork,
    NoMoreWork,
    ReplayTask,
    Result,
    ShrinkTask,
    Shrunk,
    Task,
    Work,
)
from ..oracle.failure import HANGS, PROCESS_ENDED, FuzzFailure
from ..shrink.shrinker import Shrinker
from .first_starts import START_US

Returned = TypeVar("Returned")

#: How often a failure at the start has to repeat.
_STARTS_AGAIN = 4


class WorkExecutor(MatchExecutor):
    """Runs matches of one project, and shrinks scripts beside them."""

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

        return interruption.calling(interrupt)

    def _check_interrupt(self) -> None:
        if self.interrupted:
            raise KeyboardInterrupt


@contextmanager
def open_match_executor(project: Project, jobs: int) -> Iterator[WorkExecutor]:
    """Open the executor that fits this project and platform.

    :raises RobotCodeError: when the robot's code cannot be imported
    """
    with temporary_directory("fuzz") as temporary, taking_turns():
        kind = ForkedMatchExecutor if is_forked(project.isolation) else SpawnedMatchExecutor
        with closing(kind(project, jobs, Path(temporary))) as executor:
            yield executor


def _work(project: Project, log: CrashLog, work: Work) -> Result:
    """Do one task in this process, which must end afterwards."""
    project = known_project(project)
    return _shrink(project, log, work) if isinstance(work, ShrinkTask) else play(project, log, work)


def all_lines(project: Project, log: CrashLog) -> frozenset[RobotLine]:
    """Import the robot in this process; return its lines."""
    return robot_lines(project).all


def _survey(project: Project) -> tuple[bool, frozenset[RobotLine], tuple[str, ...]]:
    """Import the robot; return whether its processes cannot be forked after that, its lines, and its libraries."""
    libraries = libraries_of(project)
    lines = robot_lines(project).all
    return bool(reasons_not_to_fork()), lines, libraries


class LocalMatchExecutor(WorkExecutor):
    """Runs each match in a process of this computer.

    :param directory: a directory for temporary files
    """

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        super().__init__(project, jobs)
        self._directory = directory
        self._journals = 0

    def run(self, next_work: NextWork) -> Generator[tuple[Work, Result], None, None]:
        running: dict[Call[Result], tuple[Work, Work]] = {}
        try:
            while True:
                self._check_interrupt()
                while (task := next_work()) is not None:
                    noted = self._with_journal(task)
                    running[self._begin(noted)] = task, noted
                if not running:
                    return
                wait_for_calls(list(running))
                # A signal that has ended this command may have ended its matches, too: they have not failed.
                self._check_interrupt()
                for call in list(running):
                    if call.finished:
                        task, noted = running.pop(call)
                        yield task, self._result(noted, call)
        except NoMoreWork:
            return
        finally:
            for call in running:
                call.close()

    @abstractmethod
    def close(self) -> None:
        """End what works for this, and undo what is prepared in this process."""

    @abstractmethod
    def _begin(self, task: Work) -> Call[Result]:
        """Begin a task."""

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
        robot, seed = self.project.main_file.name, task.schedule.robot_seed
        return MatchResult(failure, InputScript(steps, end_us, robot=robot, seed=seed))

    def _result(self, task: Work, call: Call[Result]) -> Result:
        with self._journal(task), closing(call):
            try:
                return call.result(self.project.files, MEANWHILE)
            except RobotCodeError as ended:
                return self._died(task, str(ended))


class ForkedMatchExecutor(LocalMatchExecutor):
    """Runs each match in a fork of this process, which has imported the robot, unless importing it starts threads."""

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        super().__init__(project, jobs, directory)

        # In a separate process first: an import cannot be undone.
        imports_late, self.lines, libraries = self._try(lambda: _survey(project))
        if imports_late and libraries and not self._try(lambda: import_libraries(project, libraries)):
            libraries = ()
        self._preparation = Preparation(project, not imports_late, libraries)

    def _try(self, work: Callable[[], Returned]) -> Returned:
        """Return what this returns in a fork, in which it imports something."""
        call: Call[Returned] = ForkedCall(lambda log: work(), files=self.project.files)
        with closing(call):
            call.wait()
            return call.result(self.project.files, "while it was imported")

    def close(self) -> None:
        self._preparation.close()

    def _begin(self, task: Work) -> Call[Result]:
        return ForkedCall(lambda log: _work(self.project, log, task), files=self.project.files)


class SpawnedMatchExecutor(LocalMatchExecutor):
    """Runs matches in new interpreters, which are used again while they are as good as new."""

    def __init__(self, project: Project, jobs: int, directory: Path) -> None:
        super().__init__(project, jobs, directory)
        self._interpreters = Interpreters(partial(prepare_interpreter, replace(project)), jobs)
        survey = begin_call(self._interpreters, all_lines, project, 0)
        try:
            with closing(survey):
                survey.wait()
                self.lines = survey.result(project.files, "while it was imported")
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self._interpreters.close()

    def _begin(self, task: Work) -> Call[Result]:
        return begin_call(self._interpreters, partial(_work, work=task), self.project, self.jobs)


def _shrink(project: Project, log: CrashLog, task: ShrinkTask) -> Shrunk:
    """Make a script short in this process, which has run no robot, one run at a time."""
    options = task.most_runs, task.use_oracle, task.seconds
    with open_match_executor(project, jobs=1) as executor:
        shrinker = Shrinker(executor, task.script, task.failure, task.inputs, *options)
        shrinker.shrink()
        # What fails at the start by chance may do so twice.
        again = _STARTS_AGAIN if shrinker.script.end_us <= START_US else 1
        if shrinker.repeats and all(shrinker.play_again() for _ in range(again)):
            return Shrunk(shrinker.script, shrinker.failure, True, shrinker.runs)
        return Shrunk(task.script, task.failure, runs=shrinker.runs)


def shrink_in_subprocess(project: Project, task: ShrinkTask) -> Shrunk | str:
    """Make a script short, which has made a robot raise something in this process.

    :returns: what came of it, or the end of a sentence that says why there is no shorter script
    """
    try:
        with not_watched():
            shrunk: Shrunk = run_in_subprocess(partial(_shrink, task=task), project, "while a script was made shorter")
    except PyfrcError as wrong:
        return f"it could not be made short ({wrong})"
    return shrunk if shrunk.repeats else "the robot did not fail in the same way again"
