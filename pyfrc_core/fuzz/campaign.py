"""Run a campaign: many matches, guided by the goals they reach. Each distinct failure is shrunk and saved once.

Matches are generated in batches, and their results are used in the order of their numbers. So the result of a campaign
depends on its seed alone, and not on the number of processes. With a number of matches, or when several machines play
its parts, a campaign consists of streams, which do not guide each other. With a limit of time on one machine, its
result depends on the machine's speed anyway: all matches are one stream.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, closing
from dataclasses import dataclass, field, replace
from typing import Protocol

from ..errors import PyfrcError
from ..project import Project
from ..runtime.scripts.script import InputScript
from .campaign_hints import CampaignHints
from .corpus import Corpus, CorpusEntry, found_in
from .describe import late_failure, story_of
from .failure import PROCESS_ENDED, FuzzFailure
from .goals import Goal, share
from .kept_guidance import KeptGuidance
from .match import FuzzTask, MatchResult, ReplayTask
from .match_executor import MatchExecutor, open_match_executor
from .seed_schedule import SeedSchedule
from .shrink import MOST_RUNS, Shrinker
from .stream import ALL, STREAMS, Shard, Stream

_BATCH = 32
#: How many matches of an earlier campaign are played again when the robot's code has changed.
_MOST_REVISITED = 64
#: The least time between two writes of what guides the campaign.
_KEPT_EVERY_SECONDS = 5.0

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
    :param shard: which part of the campaign to run
    :param scheduler: the address of a Dask scheduler, whose cluster runs the matches instead of this computer
    :param resume: whether to go on where the last campaign with this seed ended; its matches count in `runs`
    """

    seed: int
    runs: int | None
    seconds: float | None
    jobs: int
    recorded: tuple[InputScript, ...] = ()
    shard: Shard = ALL
    resume: bool = False
    scheduler: str | None = None


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
    :param hints: what is no failure, but may be a mistake, in words
    :param always_fails: whether it ended because the robot fails at its start in every match
    """

    progress: CampaignProgress = field(default_factory=CampaignProgress)
    findings: list[FuzzFinding] = field(default_factory=list)
    interrupted: bool = False
    real_time: tuple[str, ...] = ()
    always_fails: bool = False
    hints: CampaignHints = field(default_factory=CampaignHints)


class CampaignListener(Protocol):
    """Receives the progress and the findings of a campaign."""

    def on_progress(self, progress: CampaignProgress) -> None: ...

    def on_found(self, found: FuzzFinding) -> None: ...


def run_campaign(project: Project, options: CampaignOptions, listener: CampaignListener) -> Campaign:
    """Run a campaign to its end, or until Ctrl-C; its findings are saved in both cases.

    :raises RobotCodeError: when the robot's code cannot be imported
    :raises ScriptError: when a script in the corpus is not valid
    :raises ClusterError: when the cluster cannot run matches, or no longer: what was found by then is saved
    """
    deadline = None if options.seconds is None else time.monotonic() + options.seconds
    with _open_executor(project, options) as executor:
        runner = _Runner(executor, options, deadline, listener)
        try:
            with executor.interruptible():
                runner.replay_corpus()
                runner.run()
        except KeyboardInterrupt:
            runner.campaign.interrupted = True
            runner.save_unshrunk()
        except PyfrcError:  # matches cannot be run any more
            runner.save_unshrunk()
            raise
        finally:
            runner.keep_guidance()
        return runner.campaign


def _open_executor(project: Project, options: CampaignOptions) -> AbstractContextManager[MatchExecutor]:
    if options.scheduler is None:
        return open_match_executor(project, options.jobs)
    from .cluster import open_cluster_executor  # only where it is used: most computers have no Dask

    return open_cluster_executor(project, options.scheduler)


@dataclass(frozen=True)
class _Match:
    stream: Stream
    schedule: SeedSchedule
    #: None for a match of an earlier campaign.
    number: int | None = None


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
        self._all_lines = executor.lines
        shard = options.shard
        count = STREAMS if options.runs is not None or shard.count > 1 else 1
        played = [index for index in range(count) if shard.plays(index)]
        self._streams = [Stream(options.seed, index, count, options.recorded) for index in played]
        self._stream_batch = _BATCH // count
        self._guidance = KeptGuidance(executor.project, options.seed, shard, count, self._streams)
        #: What guides the campaign after the last complete batch.
        self._guided: str | None = None
        self._kept_at = time.monotonic()
        self._is_one_stream = count == 1
        #: The shortest scripts of failures, by the match in which they were found.
        self._shortest: dict[tuple[int | None, str], InputScript] = {}
        self._reached: set[Goal] = set()
        self._failures: list[FuzzFailure] = []
        #: Failures that are not shrunk yet.
        self._waiting: list[tuple[int | None, MatchResult]] = []
        self._shrinking: Shrinker | None = None

    def replay_corpus(self) -> None:
        """Replay the scripts of earlier campaigns; failures that are still there are reported as known."""
        scripts = list(self._corpus.all())
        with closing(self._executor.play(ReplayTask(entry.script) for entry in scripts)) as results:
            for entry, played in zip(scripts, results, strict=True):
                for each in played.each_failure():
                    if each.failure is not None and self._is_new(each.failure):
                        self._report(FuzzFinding(each.failure, story_of(entry.script, each.failure), entry, known=True))

    def _resume(self) -> None:
        """Go on where the last campaign with this seed ended, if the options say so."""
        if not self._options.resume or not self._guidance.restore():
            self._reached.update(*(stream.reached for stream in self._streams))
            return
        most = _MOST_REVISITED // len(self._streams)
        revisited = [_Match(stream, schedule) for stream in self._streams for schedule in stream.worthwhile()[-most:]]
        for stream in self._streams:
            stream.forget()
        for start in range(0, len(revisited), _BATCH):
            self._play(revisited[start : start + _BATCH])
            self._shrink_waiting()

    def run(self) -> None:
        """Run batch after batch."""
        if self._fails_at_start():
            return
        self._resume()
        while not self._is_late():
            batches = [stream.next_numbers(self._stream_batch, self._options.runs) for stream in self._streams]
            matches = [
                (number, stream) for stream, numbers in zip(self._streams, batches, strict=True) for number in numbers
            ]
            if not matches:
                return
            matches.sort(key=lambda each: each[0])
            self._play([_Match(stream, stream.schedule(number), number) for number, stream in matches])
            self._shrink_waiting()
            if self._is_late():  # perhaps before the end of the batch, which is then played again
                return
            self._avoid_frequent_failures()
            for stream, numbers in zip(self._streams, batches, strict=True):
                stream.skip(numbers)
            # Without the recorded matches, what guides the campaign is of no use.
            self._guided = None if self._options.recorded else self._guidance.snapshot()
            if time.monotonic() - self._kept_at > _KEPT_EVERY_SECONDS:
                self.keep_guidance()

    def _shrink_waiting(self) -> None:
        while self._waiting:
            self._shrink(*self._waiting[0])
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
            self._waiting.append((None, played))
            self._shrink_waiting()
        return True

    def keep_guidance(self) -> None:
        """Keep what guides the campaign after the last complete batch."""
        if self._guided is not None:
            self._guidance.write(self._guided)
            self._kept_at, self._guided = time.monotonic(), None

    def _is_late(self) -> bool:
        return self._deadline is not None and time.monotonic() >= self._deadline

    def _play(self, matches: Sequence[_Match]) -> None:
        progress = self.campaign.progress
        known_to_all = frozenset.intersection(*(stream.reached for stream in self._streams))
        tasks = [
            FuzzTask(match.schedule, match.stream.reached, known_to_all, returns_inputs=False) for match in matches
        ]
        with closing(self._executor.play(tasks)) as results:
            for match, played in zip(matches, results, strict=True):
                match.stream.learn(match.schedule, match.number, played)
                self.campaign.hints.add(played.hints)
                self._reached |= played.reached.keys()
                self.campaign.real_time = self.campaign.real_time or played.real_time
                progress.matches += 1
                progress.simulated += played.script.end_us / 1e6
                progress.covered = share(self._reached, self._all_lines) if self._reached else None
                for each in played.each_failure():
                    if each.failure is not None and self._is_new(each.failure):
                        self._waiting.append((match.number, each))
                        progress.crashes = len(self._failures)
                self._listener.on_progress(progress)
                if self._is_late():
                    return

    def _is_new(self, failure: FuzzFailure) -> bool:
        if any(failure.same_as(other) for other in self._failures):
            return False
        self._failures.append(failure)
        return True

    # -- saving -----------------------------------------------------------------------------------------------

    def _shrink(self, number: int | None, played: MatchResult) -> None:
        assert played.failure is not None
        progress = self.campaign.progress

        def report_run(runs: int) -> None:
            progress.doing = f"shrinking: run {runs}"
            self._listener.on_progress(progress)

        self._shrinking = shrinker = self._shrinker(played, report_run)
        shrinker.shrink()
        if shrinker.repeats and shrinker.play_again():
            self._save(number, shrinker.script, shrinker.failure, shrinker.runs)
            self._shortest[number, shrinker.failure.cause] = shrinker.script
            if self._is_one_stream and not played.went_on:
                self._streams[0].avoid(shrinker.failure, shrinker.script)
        else:
            self._save(number, played.script, played.failure, shrinker.runs, repeats=False)
        self._shrinking = None

    def _shrinker(self, played: MatchResult, on_run: Callable[[int], None]) -> Shrinker:
        assert played.failure is not None
        most_runs = _MOST_REAL_TIME_RUNS if self.campaign.real_time else MOST_RUNS
        return Shrinker(self._executor, played.script, played.failure, played.inputs, most_runs, on_run=on_run)

    def _avoid_frequent_failures(self) -> None:
        """Have each of several streams avoid what leads to failures that end many of its matches.

        Each needs a script of its own: what the other streams find is not known on another machine.
        """
        for stream in () if self._is_one_stream else self._streams:
            for number, played in stream.frequent_failures():
                assert played.failure is not None
                script = self._shortest.get((number, played.failure.cause))
                if script is None:
                    shrinker = self._shrinker(played, lambda runs: self._listener.on_progress(self.campaign.progress))
                    shrinker.shrink()
                    if not shrinker.repeats:
                        continue
                    script = shrinker.script
                stream.avoid(played.failure, script)

    def save_unshrunk(self) -> None:
        """Save the remaining failures as they are, after an interrupt."""
        for number, played in self._waiting:
            assert played.failure is not None
            shrinker, self._shrinking = self._shrinking, None
            if shrinker is None:
                self._save(number, played.script, played.failure, 0)
            else:
                self._save(number, shrinker.script, shrinker.failure, shrinker.runs)
        self._waiting.clear()

    def _save(
        self, number: int | None, script: InputScript, failure: FuzzFailure, runs: int, repeats: bool = True
    ) -> None:
        """Save a script, and report it: the shortest one, or of a failure that did not repeat the whole match's."""
        script = replace(script, found=found_in(self._options.seed, number, failure))
        entry = (self._corpus.add if repeats else self._corpus.keep)(script, failure)
        writes = sum(len(step.writes) for step in script.steps)
        self._report(FuzzFinding(failure, story_of(script, failure), entry, repeats, runs=runs, writes=writes))

    def _report(self, found: FuzzFinding) -> None:
        self.campaign.findings.append(found)
        self.campaign.progress.crashes = len(self._failures)
        self._listener.on_found(found)
