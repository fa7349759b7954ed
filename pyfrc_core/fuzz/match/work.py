"""What executors do: matches, replays and the shortening of scripts; their results; and the executors' interface."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...project import Project
from ...runtime.scripts.boots import PersistentEntry, persistent_entries
from ...runtime.scripts.script import InputScript
from ..guidance.goals import Goal, RobotLine
from ..guidance.seed_schedule import SeedSchedule
from ..inputs.values import Input
from ..oracle.failure import FuzzFailure, NotedFailure
from ..oracle.hints import MatchHints

#: The maximum number of runs that make a script short.
MOST_RUNS = 2_000


@dataclass(frozen=True)
class Restart:
    """What the robot program, which starts again, needs of the parts of the match before.

    :param number: that of the next part; the first part of a match is 0
    :param at_us: when the program starts again
    :param entries: the persistent entries of NetworkTables
    :param rng_state: the state of the generator of the match's random numbers
    """

    number: int
    at_us: int
    entries: tuple[PersistentEntry, ...]
    rng_state: Any = None

    @staticmethod
    def after(number: int, at_us: int, rng_state: Any = None) -> Restart:
        """Return what the part with this number, which has just ended in this process, leaves to the next one."""
        return Restart(number + 1, at_us, persistent_entries(), rng_state)


@dataclass(frozen=True)
class FuzzTask:
    """Run a match with generated inputs.

    :param schedule: the random seeds
    :param known: the goals that were reached before
    :param published: entries of NetworkTables that the program is known to write all the time
    :param always_set: the lines of code that always set an output while the robot is disabled
    :param overrides: the robot's functions for modes, see `MatchResult`
    :param watches_lines: whether goals are lines and branches, too
    :param journal: a file for the inputs, in case the process ends before it can return them
    """

    schedule: SeedSchedule
    known: frozenset[Goal] = frozenset()
    published: frozenset[str] = frozenset()
    always_set: tuple[str, ...] = ()
    overrides: tuple[str, ...] = ()
    watches_lines: bool = True
    journal: Path | None = None


@dataclass(frozen=True)
class ReplayTask:
    """Run the robot with the inputs of a script.

    :param use_oracle: whether misbehavior without an exception is a failure
    :param ends_with: misbehavior that ends the run; other misbehavior is noted
    :param hang_seconds: processor seconds without progress that count as a hang; None: those of the project's settings
    :param trace: where to write a trace; with restarts of the robot program, that of the last part
    :param ignores_missing: whether writes to devices that the robot does not have end the run without a failure
    :param quietly: whether nothing that the parts of a match with restarts print is shown
    :param paced: whether robot time waits for devices that a vendor simulates in real time, as in tests
    """

    script: InputScript
    use_oracle: bool = True
    ends_with: FuzzFailure | None = None
    hang_seconds: float | None = None
    trace: Path | None = None
    ignores_missing: bool = True
    quietly: bool = True
    paced: bool = False


Task = FuzzTask | ReplayTask


@dataclass(frozen=True)
class MatchResult:
    """Result of a match.

    :param failure: the failure that ended the match, if there was one
    :param script: the inputs until the end
    :param reached: the goals that were reached for the first time, and when, in microseconds
    :param inputs: the robot's inputs, by target
    :param unrepeatable: the robot's devices that do not repeat, as `compat.unrepeatable` names them
    :param noted: the failures after which the match went on
    :param went_on: whether the match went on after this failure
    :param hints: what is no failure, but may be a mistake
    :param restart: what the robot program needs to start again; None if the match is over
    :param published: of a replay, the entries of NetworkTables at its end that are no plain values: no one has written
        them but the program
    :param names: the names of the robot's sensors, see `device_names`
    :param overrides: of a replay, the functions such as `testInit` that the robot has for its modes
    """

    failure: FuzzFailure | None
    script: InputScript
    reached: dict[Goal, int] = field(default_factory=dict)
    inputs: dict[str, Input] = field(default_factory=dict)
    unrepeatable: tuple[str, ...] = ()
    noted: tuple[NotedFailure, ...] = ()
    went_on: bool = False
    hints: MatchHints = field(default_factory=MatchHints)
    restart: Restart | None = None
    published: frozenset[str] = frozenset()
    names: dict[str, str] = field(default_factory=dict)
    overrides: tuple[str, ...] = ()

    def with_parts_before(self, before: MatchResult | None) -> MatchResult:
        """Return the result of a part, in which the program has started again, with those of the parts before."""
        if before is None:
            return self
        return replace(
            self,
            reached=self.reached | before.reached,
            inputs=before.inputs | self.inputs,
            unrepeatable=before.unrepeatable or self.unrepeatable,
            noted=(*before.noted, *self.noted),
            hints=self.hints.with_those_before(before.hints),
        )

    def each_failure(self) -> Iterator[MatchResult]:
        """Return a result for each failure, in order, with the inputs until it."""
        for failure, end_us in self.noted:
            steps = tuple(step for step in self.script.steps if step.at_us < end_us)
            script = replace(self.script, steps=steps, end_us=min(end_us, self.script.end_us))
            yield replace(self, failure=failure, script=script, noted=(), went_on=True)
        if self.failure is not None:
            yield replace(self, noted=())


@dataclass(frozen=True)
class ShrinkTask:
    """Make a script short that has made the robot fail, in a separate process beside the matches.

    :param script: the script of the whole match
    :param inputs: the kinds of its targets' values, as far as they are known
    :param most_runs: how many robots to run at most
    :param seconds: after this time, take the shortest script so far; None: without a limit
    :param use_oracle: whether misbehavior without an exception is a failure
    """

    script: InputScript
    failure: FuzzFailure
    inputs: Mapping[str, Input] = field(default_factory=dict)
    most_runs: int = MOST_RUNS
    seconds: float | None = None
    use_oracle: bool = True


@dataclass(frozen=True)
class Shrunk:
    """Result of a `ShrinkTask`.

    :param script: the shortest script; that of the whole match if `repeats` is False
    :param failure: how the robot fails with it
    :param repeats: whether it failed again
    :param runs: how many robots were run
    """

    script: InputScript
    failure: FuzzFailure
    repeats: bool = False
    runs: int = 0


Work = Task | ShrinkTask
Result = MatchResult | Shrunk
#: Returns what to begin now; None to wait for what is running; raises `NoMoreWork`.
NextWork = Callable[[], Work | None]


class NoMoreWork(Exception):
    """Ends what is running, without its result."""


class MatchExecutor(ABC):
    """Runs matches of one project.

    :param jobs: how many at a time
    """

    def __init__(self, project: Project, jobs: int) -> None:
        self.project = project
        self.jobs = jobs
        #: The lines of the robot's functions.
        self.lines: frozenset[RobotLine] = frozenset()
        #: Set to end the matches: `play` then raises `KeyboardInterrupt`. (An exception raised by a signal handler
        #: would be lost if it came during a fork.)
        self.interrupted = False

    @abstractmethod
    def play(self, tasks: Iterable[Task]) -> Generator[MatchResult, None, None]:
        """Return the results in the order of the tasks, each as soon as it is known; closing the generator ends the
        remaining tasks.
        """

    def replay(self, script: InputScript) -> MatchResult:
        """Run the robot with the inputs of a script."""
        (played,) = self.play([ReplayTask(script)])
        return played
