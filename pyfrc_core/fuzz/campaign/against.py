"""Compare the robot's code with that of another commit: the same inputs, and where outputs first differ.

Two versions of a module cannot be imported in one process. So the other commit's matches are played in another one.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import count, islice
from multiprocessing.connection import Pipe
from pathlib import Path

from ...processes.call import ForkedCall, run_in_subprocess
from ...processes.crash_report import CrashLog
from ...processes.fork import is_forked
from ...project import Project
from ...runtime.clock import PACKET_US, to_us
from ...runtime.scripts.script import InputScript
from ...runtime.scripts.trace_difference import first_difference
from ...text_files import keep_out_of_version_control
from ..guidance.goals import RobotLine
from ..inputs.values import Input
from ..match.work import FuzzTask, MatchExecutor, MatchResult, ReplayTask, Task
from ..oracle.failure import FuzzFailure
from ..shrink.shrinker import Shrinker
from .describe import story_of
from .executors import open_match_executor
from .results import CampaignOptions
from .revision import Revision, exported
from .stream import Stream

#: The kind of a difference, which is shortened as a failure is.
DIFFERS = "differs"

_BATCH = 16
_MOST_SHRINKING_RUNS = 200


@dataclass(frozen=True)
class Comparison:
    """Result of a comparison.

    :param revision: the short hash and the subject of the other commit
    :param matches: how many matches were compared
    :param seconds: their robot time
    :param difference: where outputs first differ, in words; empty if they do not
    :param story: the inputs that lead to it
    :param file: the script with these inputs
    """

    revision: str
    matches: int
    seconds: float
    difference: str = ""
    story: tuple[str, ...] = ()
    file: Path | None = None


def compare(project: Project, revision: str, options: CampaignOptions) -> Comparison:
    """Play matches with this code and with a commit's, until outputs differ or the campaign is over.

    :raises UsageError: when there is no such commit
    :raises RobotCodeError: when the code of either cannot be imported
    """
    deadline = None if options.seconds is None else time.monotonic() + options.seconds
    with (
        exported(project, revision) as other,
        open_other_commit(other.project, options.jobs) as (play_other, is_ready),
        open_match_executor(project, options.jobs) as executor,
        tempfile.TemporaryDirectory(prefix="pyfrc-traces-") as traces,
        executor.interruptible(),
    ):
        both = _BothVersions(executor, play_other, is_ready, Path(traces))
        stream = Stream(options.seed, 0, 1, options.recorded)
        matches, seconds = 0, 0.0
        while (options.runs is None or matches < options.runs) and (deadline is None or time.monotonic() < deadline):
            size = _BATCH if options.runs is None else min(_BATCH, options.runs - matches)
            schedules = [stream.scheduler.schedule(number) for number in range(matches, matches + size)]
            known = stream.reached
            generated = list(executor.play(FuzzTask(schedule, known) for schedule in schedules))
            for number, (schedule, match) in enumerate(zip(schedules, generated, strict=True), matches):
                stream.learn(schedule, number, match)
            tasks = [ReplayTask(match.script, use_oracle=False) for match in generated]
            with closing(both.play(tasks)) as results:
                for match, played in zip(generated, results, strict=True):
                    matches += 1
                    seconds += played.script.end_us / 1e6
                    if played.failure is not None:
                        return _shortest(both, other, played, match.inputs, Comparison(other.name, matches, seconds))
        return Comparison(other.name, matches, seconds)


def _shortest(
    both: _BothVersions, other: Revision, played: MatchResult, inputs: dict[str, Input], so_far: Comparison
) -> Comparison:
    assert played.failure is not None
    shrinker = Shrinker(both, played.script, played.failure, inputs, _MOST_SHRINKING_RUNS, use_oracle=False)
    shrinker.shrink()
    script = shrinker.script if shrinker.repeats else played.script
    directory = both.project.root / ".pyfrc"
    file = directory / "fuzz" / f"against-{other.name.partition(' ')[0]}.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    keep_out_of_version_control(directory)
    script.save(file)
    *story, what = story_of(script, shrinker.failure)
    return replace(so_far, difference=what, story=tuple(story), file=file)


class _BothVersions(MatchExecutor):
    """Plays each script with both versions of the code: a difference is the result's failure."""

    def __init__(self, executor: MatchExecutor, play_other: Play, is_ready: bool, directory: Path) -> None:
        super().__init__(executor.project, executor.jobs, directory)
        self._executor = executor
        self._play_other = play_other
        #: How many tasks to play together: the caller may not need all, but calls of the other commit may be slow.
        self._sizes = (self.jobs, self.jobs) if is_ready else (2 * self.jobs, _BATCH)
        self._numbers = count()

    @property
    def lines(self) -> frozenset[RobotLine]:
        return self._executor.lines

    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        left = iter(tasks)
        size, later = self._sizes
        while together := [task for task in islice(left, size) if isinstance(task, ReplayTask)]:
            yield from self._compare([replace(task, ends_with=None) for task in together])
            size = later

    def _compare(self, tasks: Sequence[ReplayTask]) -> list[MatchResult]:
        mine, theirs = self._traced(tasks), self._traced(tasks)
        now = list(self._executor.play(mine))
        before = self._play_other(theirs)
        files = [(task.trace, other.trace) for task, other in zip(mine, theirs, strict=True)]
        results = []
        for played, other, (file, other_file) in zip(now, before, files, strict=True):
            assert file is not None
            assert other_file is not None
            results.append(_difference(played, other, file, other_file))
            file.unlink(missing_ok=True)
            other_file.unlink(missing_ok=True)
        return results

    def _traced(self, tasks: Sequence[ReplayTask]) -> list[ReplayTask]:
        return [replace(task, trace=self._directory / f"{next(self._numbers)}.trace.jsonl") for task in tasks]


def _difference(now: MatchResult, before: MatchResult, file: Path, file_before: Path) -> MatchResult:
    """Return the match with its first difference as its failure."""
    end_us = min(now.script.end_us, before.script.end_us)
    failed = [None if played.failure is None else played.failure.kind for played in (before, now)]
    found = None
    if file.is_file() and file_before.is_file():
        # After a failure, a trace ends.
        found = first_difference(file_before, file, end_us - PACKET_US if failed[0] != failed[1] else None)
    if found is not None:
        end_us = to_us(found.now) + PACKET_US
        failure = FuzzFailure(DIFFERS, found.path, "", f"{found.path} was {found.recorded!r}, is {found.replayed!r}")
    elif failed[0] != failed[1]:
        texts = [
            "no failure" if played.failure is None else played.failure.text.partition("\n")[0]
            for played in (before, now)
        ]
        failure = FuzzFailure(DIFFERS, f"failure {failed}", "", f"there was {texts[0]}, there is {texts[1]}")
    else:
        return MatchResult(None, now.script)
    steps = tuple(step for step in now.script.steps if step.at_us < end_us)
    return MatchResult(failure, InputScript(steps, end_us, robot=now.script.robot, seed=now.script.seed))


# -- the other commit --------------------------------------------------------------------------------------------------

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
    if not is_forked(project.isolation):
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
