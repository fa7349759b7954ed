"""Run a campaign: many matches, guided by the lines they reach. Each distinct failure is shrunk and saved once.

Matches are generated in batches, and their results are used in the order of their numbers. So the result of a campaign
depends on its seed alone, and not on the number of processes.
"""

from __future__ import annotations

import time
from contextlib import closing
from dataclasses import dataclass, field
from typing import Protocol

from ..project import Project
from ..runtime.scripts.script import InputScript
from .corpus import Corpus, CorpusEntry
from .describe import late_failure, story_of
from .failure import PROCESS_ENDED, FuzzFailure
from .goals import Goal, share
from .match import FuzzTask, MatchResult, ReplayTask
from .match_executor import MatchExecutor, open_match_executor
from .seed_schedule import SeedScheduler
from .shrink import MOST_RUNS, Shrinker

_BATCH = 32

#: A robot that fails within this time without any input fails in every match.
_START_US = 2_000_000

#: The maximum number of runs to shrink a script of a robot that does not repeat: runs that fail by chance prove little.
_MOST_REAL_TIME_RUNS = 50


@dataclass(frozen=True)
class CampaignOptions:
    """Options of a campaign.

    :param seed: the random seed
    :param runs: the number of matches, or None
    :param seconds: when to start no more matches, in seconds of real time, or None; failures found by then are still
        shrunk
    :param jobs: how many matches to run at a time
    :param recorded: recorded matches to begin with
    """

    seed: int
    runs: int | None
    seconds: float | None
    jobs: int
    recorded: tuple[InputScript, ...] = ()


@dataclass
class CampaignProgress:
    """Progress of a campaign.

    :param matches: how many matches were run
    :param simulated: robot time, in seconds
    :param covered: the share of the robot's lines that was reached, from 0 to 1; None when no lines were observed, as
        on systems where they cannot be
    :param crashes: the number of distinct failures
    :param doing: the current activity
    """

    matches: int = 0
    simulated: float = 0.0
    covered: float | None = None
    crashes: int = 0
    doing: str = ""


@dataclass(frozen=True)
class FuzzFinding:
    """A failure, with what a user needs to know of it.

    :param failure: the failure
    :param story: the events that lead to it, one line each; the failure comes last
    :param entry: the saved script
    :param repeats: whether the robot failed again with the script; if not, it is the script of the whole match
    :param known: whether an earlier campaign saved it
    :param runs: how many matches it took to shrink the script
    :param writes: how many writes the shortest script has
    """

    failure: FuzzFailure
    story: tuple[str, ...]
    entry: CorpusEntry
    repeats: bool = True
    known: bool = False
    runs: int = 0
    writes: int = 0

    @property
    def fails_at(self) -> float | None:
        """Return when the robot fails, in seconds, if that is known and not soon after the last input."""
        return None if self.failure.kind == PROCESS_ENDED else late_failure(self.entry.script)


@dataclass
class Campaign:
    """Result of a campaign.

    :param progress: how far it came
    :param findings: the failures that it found
    :param interrupted: whether the user interrupted it
    :param real_time: the robot's devices that do not repeat, as `compat.real_time_devices` names them
    :param always_fails: whether it ended because the robot fails at its start in every match
    """

    progress: CampaignProgress = field(default_factory=CampaignProgress)
    findings: list[FuzzFinding] = field(default_factory=list)
    interrupted: bool = False
    real_time: tuple[str, ...] = ()
    always_fails: bool = False


class CampaignListener(Protocol):
    """Receives the progress and the findings of a campaign."""

    def on_progress(self, progress: CampaignProgress) -> None: ...

    def on_found(self, found: FuzzFinding) -> None: ...


def run_campaign(project: Project, options: CampaignOptions, listener: CampaignListener) -> Campaign:
    """Run a campaign to its end, or until Ctrl-C; its findings are saved in both cases.

    :raises RobotCodeError: when the robot's code cannot be imported
    :raises ScriptError: when a script in the corpus is not valid
    """
    deadline = None if options.seconds is None else time.monotonic() + options.seconds
    with open_match_executor(project, options.jobs) as executor:
        runner = _Runner(executor, options, deadline, listener)
        try:
            with executor.interruptible():
                runner.replay_corpus()
                runner.run()
        except KeyboardInterrupt:
            runner.campaign.interrupted = True
            runner.save_unshrunk()
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
        self._corpus = Corpus(executor.project)
        self._scheduler = SeedScheduler(options.seed, options.recorded)
        self._all_lines = executor.lines
        self._reached: frozenset[Goal] = frozenset()
        self._failures: list[FuzzFailure] = []
        #: Failures that are not shrunk yet.
        self._waiting: list[MatchResult] = []
        self._shrinking: Shrinker | None = None

    def replay_corpus(self) -> None:
        """Replay the scripts of earlier campaigns; failures that are still there are reported as known."""
        scripts = list(self._corpus.all())
        with closing(self._executor.play(ReplayTask(entry.script) for entry in scripts)) as results:
            for entry, played in zip(scripts, results, strict=True):
                for each in played.each_failure():
                    if each.failure is not None and self._is_new(each.failure):
                        self._report(FuzzFinding(each.failure, story_of(entry.script, each.failure), entry, known=True))

    def run(self) -> None:
        """Run batch after batch."""
        number = 0
        if self._fails_at_start():
            return
        while not self._over(number):
            size = _BATCH if self._options.runs is None else min(_BATCH, self._options.runs - number)
            self._play(range(number, number + size))
            number += size
            self._shrink_waiting()

    def _shrink_waiting(self) -> None:
        while self._waiting:
            self._shrink(self._waiting[0])
            self._waiting.pop(0)
        self.campaign.progress.doing = ""

    def _fails_at_start(self) -> bool:
        """Return whether the robot fails at its start without any input, as it would in every match; report it."""
        played = self._executor.replay(InputScript((), _START_US, robot=self._executor.project.main_file.name))
        if played.failure is None:
            return False
        self.campaign.always_fails = True
        self.campaign.progress.matches = 1
        if self._is_new(played.failure):
            self._waiting.append(played)
            self._shrink_waiting()
        return True

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
                self._scheduler.note_end(schedule, played.failure)
                self._reached |= new.keys()
                self.campaign.real_time = self.campaign.real_time or played.real_time
                progress.matches += 1
                progress.simulated += played.script.end_us / 1e6
                progress.covered = share(self._reached, self._all_lines) if self._reached else None
                for each in played.each_failure():
                    if each.failure is not None and self._is_new(each.failure):
                        self._waiting.append(each)
                        progress.crashes = len(self._failures)
                self._listener.on_progress(progress)
                if self._over(0):
                    return

    def _is_new(self, failure: FuzzFailure) -> bool:
        if any(failure.same_as(other) for other in self._failures):
            return False
        self._failures.append(failure)
        return True

    # -- saving -----------------------------------------------------------------------------------------------

    def _shrink(self, played: MatchResult) -> None:
        assert played.failure is not None
        progress = self.campaign.progress

        def report_run(runs: int) -> None:
            progress.doing = f"shrinking: run {runs}"
            self._listener.on_progress(progress)

        most_runs = _MOST_REAL_TIME_RUNS if self.campaign.real_time else MOST_RUNS
        shrinker = Shrinker(self._executor, played.script, played.failure, played.inputs, most_runs, on_run=report_run)
        self._shrinking = shrinker
        shrinker.shrink()
        if shrinker.repeats and shrinker.play_again():
            self._save(shrinker.script, shrinker.failure, shrinker.runs)
            if not played.went_on:
                self._scheduler.avoid(shrinker.failure, shrinker.script)
        else:
            self._save(played.script, played.failure, shrinker.runs, repeats=False)
        self._shrinking = None

    def save_unshrunk(self) -> None:
        """Save the remaining failures as they are, after an interrupt."""
        for played in self._waiting:
            assert played.failure is not None
            shrinker, self._shrinking = self._shrinking, None
            if shrinker is None:
                self._save(played.script, played.failure, 0)
            else:
                self._save(shrinker.script, shrinker.failure, shrinker.runs)
        self._waiting.clear()

    def _save(self, script: InputScript, failure: FuzzFailure, runs: int, repeats: bool = True) -> None:
        """Save a script, and report it: the shortest one, or of a failure that did not repeat the whole match's."""
        entry = (self._corpus.add if repeats else self._corpus.keep)(script, failure)
        writes = sum(len(step.writes) for step in script.steps)
        self._report(FuzzFinding(failure, story_of(script, failure), entry, repeats, runs=runs, writes=writes))

    def _report(self, found: FuzzFinding) -> None:
        self.campaign.findings.append(found)
        self.campaign.progress.crashes = len(self._failures)
        self._listener.on_found(found)
