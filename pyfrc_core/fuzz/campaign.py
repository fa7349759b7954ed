"""A campaign: many matches, steered by the lines they reach; each different failure once, made short, and kept.

Matches are made up and learned from in batches, in the order of their numbers. So what a campaign does follows from
its seed alone, in however many processes it runs.
"""

from __future__ import annotations

import time
from contextlib import closing
from dataclasses import dataclass, field
from typing import Protocol

from ..project import Project
from .corpus import Corpus, CorpusEntry
from .describe import story_of
from .failure import FuzzFailure
from .lines import Line, share
from .match import FuzzTask, MatchResult, ReplayTask
from .match_executor import MatchExecutor, open_match_executor
from .seed_schedule import SeedScheduler
from .shrink import Shrinker

_BATCH = 32


@dataclass(frozen=True)
class CampaignOptions:
    """How a campaign was asked for.

    :param seed: what all its chance comes from
    :param runs: how many matches, or None
    :param seconds: for how long, in real time, or None; what was found by then is made short all the same
    :param jobs: how many robots at a time
    """

    seed: int
    runs: int | None
    seconds: float | None
    jobs: int


@dataclass
class CampaignProgress:
    """How far a campaign has come.

    :param simulated: robot time, in seconds
    :param covered: how much of the robot's lines was reached, from 0 to 1; None while none was seen to be, as where
        lines cannot be watched
    :param crashes: how many different failures there are
    :param doing: what it does now
    """

    matches: int = 0
    simulated: float = 0.0
    covered: float | None = None
    crashes: int = 0
    doing: str = ""


@dataclass(frozen=True)
class FuzzFinding:
    """A failure, for people.

    :param story: what happens, moment by moment; the failure last
    :param kept: where the way there is; None when it did not fail in the same way again
    :param known: whether an earlier campaign had kept it
    :param runs: how many robots were run to make it short
    :param writes: how many things the shortest way writes
    """

    failure: FuzzFailure
    story: tuple[str, ...]
    kept: CorpusEntry | None
    known: bool = False
    runs: int = 0
    writes: int = 0


@dataclass
class Campaign:
    """What came of a campaign.

    :param interrupted: whether somebody has ended it
    """

    progress: CampaignProgress = field(default_factory=CampaignProgress)
    found: list[FuzzFinding] = field(default_factory=list)
    interrupted: bool = False


class CampaignListener(Protocol):
    """Whoever is told how a campaign goes."""

    def on_progress(self, progress: CampaignProgress) -> None: ...

    def on_found(self, found: FuzzFinding) -> None: ...


def run_campaign(project: Project, options: CampaignOptions, listener: CampaignListener) -> Campaign:
    """Run a campaign to its end, or until Ctrl-C: then what it has found is kept, too.

    :raises RobotCodeError: when the robot's code cannot be imported
    :raises ScriptError: when a script that was kept before is none
    """
    deadline = None if options.seconds is None else time.monotonic() + options.seconds
    with open_match_executor(project, options.jobs) as executor:
        runner = _Runner(executor, options, deadline, listener)
        try:
            with executor.interruptible():
                runner.look_at_kept()
                runner.run()
        except KeyboardInterrupt:
            runner.campaign.interrupted = True
            runner.keep_the_rest()
        return runner.campaign


class _Runner:
    def __init__(
        self, executor: MatchExecutor, options: CampaignOptions, deadline: float | None, listener: CampaignListener
    ) -> None:
        self.campaign = Campaign()
        self._executor = executor
        self._options = options
        self._deadline = deadline
        self._listener = listener
        self._kept = Corpus(executor.project)
        self._scheduler = SeedScheduler(options.seed)
        self._all_lines = executor.lines
        self._reached: frozenset[Line] = frozenset()
        self._failures: list[FuzzFailure] = []
        #: Found, and not made short yet.
        self._waiting: list[MatchResult] = []
        self._shrinking: Shrinker | None = None

    def look_at_kept(self) -> None:
        """What earlier campaigns have found, and is not repaired, is not found anew."""
        scripts = list(self._kept.all())
        with closing(self._executor.play(ReplayTask(kept.script) for kept in scripts)) as results:
            for kept, played in zip(scripts, results, strict=True):
                if played.failure is not None and self._is_new(played.failure):
                    self._tell(FuzzFinding(played.failure, story_of(kept.script, played.failure), kept, known=True))

    def run(self) -> None:
        """Play batch after batch."""
        number = 0
        while not self._over(number):
            size = _BATCH if self._options.runs is None else min(_BATCH, self._options.runs - number)
            self._play(range(number, number + size))
            number += size
            while self._waiting:
                self._keep(self._waiting[0])
                self._waiting.pop(0)
            self.campaign.progress.doing = ""

    def _over(self, number: int) -> bool:
        if self._deadline is not None and time.monotonic() >= self._deadline:
            return True
        return self._options.runs is not None and number >= self._options.runs

    def _play(self, numbers: range) -> None:
        progress = self.campaign.progress
        schedules = [self._scheduler.schedule(number) for number in numbers]
        known = self._reached
        with closing(self._executor.play(FuzzTask(schedule, known) for schedule in schedules)) as results:
            for schedule, played in zip(schedules, results, strict=True):
                new = {line: at_us for line, at_us in played.reached.items() if line not in self._reached}
                self._scheduler.learn(schedule, new)
                self._reached |= new.keys()
                progress.matches += 1
                progress.simulated += played.script.end_us / 1e6
                progress.covered = share(self._reached, self._all_lines) if self._reached else None
                if played.failure is not None and self._is_new(played.failure):
                    self._waiting.append(played)
                    progress.crashes = len(self._failures)
                self._listener.on_progress(progress)
                if self._over(0):
                    return

    def _is_new(self, failure: FuzzFailure) -> bool:
        if any(failure.same_as(other) for other in self._failures):
            return False
        self._failures.append(failure)
        return True

    # -- keeping -----------------------------------------------------------------------------------------------

    def _keep(self, played: MatchResult) -> None:
        assert played.failure is not None
        progress = self.campaign.progress

        def tell(runs: int) -> None:
            progress.doing = f"making it short: run {runs}"
            self._listener.on_progress(progress)

        shrinker = Shrinker(self._executor, played.script, played.failure, played.inputs, tell=tell)
        self._shrinking = shrinker
        shrinker.shrink()
        self._write(shrinker, repeats=shrinker.repeats and shrinker.play_again())
        self._shrinking = None

    def keep_the_rest(self) -> None:
        """Somebody has ended the campaign: what it has found is kept as it is now."""
        for played in self._waiting:
            assert played.failure is not None
            shrinker, self._shrinking = self._shrinking, None
            self._write(shrinker or Shrinker(self._executor, played.script, played.failure, {}), repeats=True)
        self._waiting.clear()

    def _write(self, shrinker: Shrinker, repeats: bool) -> None:
        script, failure = shrinker.script, shrinker.failure
        kept = self._kept.keep(script, failure) if repeats else None
        writes = sum(len(step.writes) for step in script.steps)
        self._tell(FuzzFinding(failure, story_of(script, failure), kept, runs=shrinker.runs, writes=writes))

    def _tell(self, found: FuzzFinding) -> None:
        self.campaign.found.append(found)
        self.campaign.progress.crashes = len(self._failures)
        self._listener.on_found(found)
