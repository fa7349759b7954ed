"""Run a campaign: many matches, guided by the goals they reach. Each distinct failure is shrunk and saved once.

Failures are shrunk in processes of their own, beside the matches, which go on. With a limit of time on
one machine, matches are one stream (`stream`), and the next one follows from all results that are known when it begins.
With a number of matches, or when several machines play its parts, a campaign consists of several streams, which do not
guide each other. Their matches are played in batches, and the results of a batch are used in the order of their
numbers. So the result depends on the seed alone, and not on the number of processes.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from contextlib import AbstractContextManager, closing
from dataclasses import dataclass, replace

from ...errors import PyfrcError
from ...processes.standstill import REPORTED_AFTER
from ...wording import counted
from ..guidance.goals import Goal
from ..match.work import MOST_RUNS, FuzzTask, MatchResult, NoMoreWork, ReplayTask, ShrinkTask, Shrunk
from ..oracle.failure import FuzzFailure
from .corpus import Corpus, found_in
from .describe import story_of
from .executors import WorkExecutor
from .first_starts import START_US, STARTS, try_starts
from .kept_guidance import KeptGuidance
from .playing import Match, Playing
from .results import Campaign, CampaignListener, CampaignOptions, FuzzFinding
from .stream import STREAMS, Stream

#: How many matches of an earlier campaign are played again when the robot's code has changed.
_MOST_REVISITED = 64
#: The least time between two writes of what guides the campaign.
_KEPT_EVERY_SECONDS = 5.0

#: How many seconds shrinking one failure may take, in a campaign with a limit of time.
_LEAST_SECONDS, _MOST_SECONDS = 3.0, 60.0

#: The maximum number of runs to shrink a script of a robot that does not repeat: runs that fail by chance prove little.
_MOST_UNREPEATABLE_RUNS = 50


def run_campaign(
    opening: AbstractContextManager[WorkExecutor], options: CampaignOptions, listener: CampaignListener
) -> Campaign:
    """Run a campaign to its end, or until Ctrl-C; its findings are saved in both cases.

    :param opening: `open_match_executor` or `open_cluster_executor`

    :raises RobotCodeError: when the robot's code cannot be imported
    :raises ScriptError: when a script in the corpus is not valid
    :raises ClusterError: when the cluster cannot run matches, or no longer: what was found by then is saved
    """
    deadline = None if options.seconds is None else time.monotonic() + options.seconds
    with opening as executor:
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


@dataclass(frozen=True)
class _Failed:
    """A failure whose script is not short yet.

    :param number: that of its match; None for a match of an earlier campaign
    :param is_new: whether it is to be saved and reported
    """

    number: int | None
    played: MatchResult
    is_new: bool = True

    @property
    def failure(self) -> FuzzFailure:
        assert self.played.failure is not None
        return self.played.failure

    @property
    def key(self) -> tuple[int | None, str]:
        return self.number, self.failure.cause


class _Runner:
    def __init__(
        self, executor: WorkExecutor, options: CampaignOptions, deadline: float | None, listener: CampaignListener
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
        self._guidance = KeptGuidance(executor.project, options.seed, shard, count, self._streams)
        #: What guides the campaign after the last complete batch.
        self._guided: str | None = None
        self._kept_at = time.monotonic()
        self._playing = Playing(executor.project, self._streams, options.runs, options.seconds, in_batches=count > 1)
        self._reached: set[Goal] = set()
        self._failures: list[FuzzFailure] = []
        #: Failures that wait to be shrunk, and those that are being shrunk, by the identity of their task.
        self._waiting: deque[_Failed] = deque()
        self._shrinking: dict[int, tuple[ShrinkTask, _Failed]] = {}
        #: What has been shrunk, or will be, by the match and the cause.
        self._shrunk: dict[tuple[int | None, str], Shrunk | None] = {}
        #: New failures in the order of their matches: they are saved in this order.
        self._to_save: deque[_Failed] = deque()

    def replay_corpus(self) -> None:
        """Replay the scripts of earlier campaigns; failures that are still there are reported as known."""
        scripts = list(self._corpus.all())
        with closing(self._executor.play(ReplayTask(entry.script, paced=True) for entry in scripts)) as results:
            for entry, played in zip(scripts, results, strict=True):
                for each in played.each_failure():
                    if each.failure is not None and self._is_new(each.failure):
                        self._report(FuzzFinding(each.failure, story_of(entry.script, each.failure), entry, known=True))

    def run(self) -> None:
        """Play matches, and shrink the failures beside them, until the end."""
        if self._fails_at_start():
            self._playing.end()
        else:
            self._resume()
        with closing(self._executor.run(self._next_work)) as results:
            for work, result in results:
                if isinstance(result, Shrunk):
                    self._on_shrunk(self._shrinking.pop(id(work))[1], result)
                elif isinstance(work, FuzzTask):
                    for match, played in self._playing.finish(work, result):
                        self._learn(match, played)
                self._listener.on_progress(self.campaign.progress)

    def _resume(self) -> None:
        """Go on where the last campaign with this seed ended, if the options say so."""
        if not self._options.resume or not self._guidance.restore():
            self._reached.update(*(stream.reached for stream in self._streams))
            return
        most = _MOST_REVISITED // len(self._streams)
        revisited = [
            Match(stream, schedule) for stream in self._streams for schedule in stream.scheduler.worthwhile()[-most:]
        ]
        for stream in self._streams:
            stream.forget()
        self._playing.revisit(revisited)

    def _fails_at_start(self) -> bool:
        """Return whether the robot fails at its start in any case, as it would in every match; report it."""
        starts = try_starts(self._executor)
        if starts.seconds >= REPORTED_AFTER:
            print(f"each match begins with about {starts.seconds:.0f} s of starting this robot", file=sys.stderr)
        self._playing.published, self._playing.always_set = starts.published, tuple(starts.always_set)
        hints = self.campaign.hints
        hints.always_set += [failure.place for failure in starts.always_set.values()]
        hints.starts += STARTS
        for failure in starts.unsteady:
            hints.failed_starts[failure.cause] += 1
            self._note_unsteady(failure)
        if starts.always_fails is None:
            return False
        self.campaign.always_fails = True
        self.campaign.progress.matches = STARTS
        self._note_failure(None, starts.always_fails)
        return True

    def _note_unsteady(self, failure: FuzzFailure) -> None:
        """Note that a failure at the start has not repeated: it is a hint, and the campaign goes on."""
        self.campaign.hints.unsteady[failure.cause] = failure.text.partition("\n")[0]

    # -- what is next ------------------------------------------------------------------------------------------

    def _next_work(self) -> FuzzTask | ShrinkTask | None:
        jobs, late = self._executor.jobs, self._is_late()
        if late and not self._waiting and not self._shrinking:
            raise NoMoreWork
        is_only_shrunk = late or self._playing.over or self._playing.is_between_batches
        if self._waiting and len(self._shrinking) < (jobs if is_only_shrunk else max(1, jobs // 2)):
            return self._next_shrinking()
        if late or self._playing.over or self._playing.running >= max(1, jobs - len(self._shrinking)):
            return None
        if self._playing.is_between_batches and not self._end_batch():
            return None
        return self._playing.next_task()

    def _next_shrinking(self) -> ShrinkTask:
        failed = self._waiting.popleft()
        most_runs = _MOST_UNREPEATABLE_RUNS if self.campaign.unrepeatable else MOST_RUNS
        seconds = None
        if (left := self._seconds_left()) is not None:  # shared with those that wait
            seconds = max(_LEAST_SECONDS, min(_MOST_SECONDS, left / (1 + len(self._waiting))))
        task = ShrinkTask(failed.played.script, failed.failure, failed.played.inputs, most_runs, seconds)
        self._shrinking[id(task)] = task, failed
        self._count_shrinking()
        return task

    def _end_batch(self) -> bool:
        """Return whether the next batch may begin: when it is known which frequent failures it avoids."""
        is_complete = True
        for stream in self._streams if self._playing.in_batches else ():
            for number, played in stream.frequent_failures():
                failed = _Failed(number, played, is_new=False)
                if failed.key not in self._shrunk:
                    self._shrunk[failed.key] = None
                    self._waiting.append(failed)
                shrunk = self._shrunk[failed.key]
                if shrunk is None:
                    stream.ask_again(number, played)
                    is_complete = False
                elif shrunk.repeats:
                    stream.scheduler.avoid(shrunk.failure, shrunk.script)
        if is_complete:
            self._guided = self._guidance.snapshot()
            self._keep_guidance_at_times()
        return is_complete

    def _seconds_left(self) -> float | None:
        """Return the seconds in which matches are played; the rest is for the failures that wait to be shrunk."""
        if self._deadline is None:
            return None
        return self._deadline - time.monotonic() - _LEAST_SECONDS * len(self._waiting) / self._executor.jobs

    def _is_late(self) -> bool:
        left = self._seconds_left()
        return left is not None and left <= 0

    # -- results -----------------------------------------------------------------------------------------------

    def _learn(self, match: Match, played: MatchResult) -> None:
        progress = self.campaign.progress
        match.stream.learn(match.schedule, match.number, played)
        self.campaign.hints.add(played.hints)
        self._reached |= played.reached.keys()
        self.campaign.unrepeatable = self.campaign.unrepeatable or played.unrepeatable
        progress.matches += 1
        progress.simulated += played.script.end_us / 1e6
        if self._reached:
            lines = self._all_lines
            progress.covered = len(lines.intersection(self._reached)) / len(lines) if lines else 1.0
        for each in played.each_failure():
            self._note_failure(match.number, each)
        if not self._playing.in_batches:
            self._keep_guidance_at_times()

    def _note_failure(self, number: int | None, played: MatchResult) -> None:
        if played.failure is None:
            return
        hints, cause = self.campaign.hints, played.failure.cause
        hints.failed_starts[cause] += played.script.end_us <= START_US
        if cause in hints.unsteady or not self._is_new(played.failure):
            return
        failed = _Failed(number, played)
        self._shrunk[failed.key] = None
        self._waiting.append(failed)
        self._to_save.append(failed)
        self.campaign.progress.crashes = len(self._failures)
        self._listener.on_seen(failed.failure)

    def _on_shrunk(self, failed: _Failed, shrunk: Shrunk) -> None:
        self._shrunk[failed.key] = shrunk
        if shrunk.repeats and not self._playing.in_batches and not failed.played.went_on:
            self._streams[0].scheduler.avoid(shrunk.failure, shrunk.script)
        self._count_shrinking()
        while self._to_save and (done := self._shrunk[self._to_save[0].key]) is not None:
            self._save(self._to_save.popleft(), done)

    def _count_shrinking(self) -> None:
        number = len(self._shrinking) + len(self._waiting)
        self.campaign.progress.doing = f"shrinking {counted(number, 'script')}" if number else ""

    def _keep_guidance_at_times(self) -> None:
        if time.monotonic() - self._kept_at > _KEPT_EVERY_SECONDS:
            self.keep_guidance()

    def keep_guidance(self) -> None:
        """Keep what guides the campaign now; of batches, after the last complete one."""
        if not self._playing.in_batches and self.campaign.progress.simulated:
            self._guided = self._guidance.snapshot()
        if self._guided is not None and not self._options.recorded:
            self._guidance.write(self._guided)
        self._kept_at, self._guided = time.monotonic(), None

    def _is_new(self, failure: FuzzFailure) -> bool:
        if any(failure.same_as(other) for other in self._failures):
            return False
        self._failures.append(failure)
        return True

    # -- saving -----------------------------------------------------------------------------------------------

    def save_unshrunk(self) -> None:
        """Save the remaining failures as they are, after an interrupt."""
        for failed in self._to_save:
            self._save(failed, self._shrunk[failed.key] or Shrunk(failed.played.script, failed.failure, repeats=True))
        self._to_save.clear()

    def _save(self, failed: _Failed, shrunk: Shrunk) -> None:
        """Save a script, and report it: the shortest one, or of a failure that did not repeat the whole match's."""
        failure = shrunk.failure
        if not shrunk.repeats and failed.played.script.end_us <= START_US:
            self._failures.remove(failed.failure)
            self.campaign.progress.crashes = len(self._failures)
            self._note_unsteady(failed.failure)
            return
        story = story_of(shrunk.script, failure, failed.played.names)
        script = replace(shrunk.script, story=story)
        script = replace(script, found={**script.found, **found_in(self._options.seed, failed.number, failure)})
        entry = self._corpus.add(replace(script, repeats=shrunk.repeats), failure)
        self.campaign.problem = self._corpus.problem
        writes = sum(len(step.writes) for step in script.steps)
        self._report(FuzzFinding(failure, story, entry, shrunk.repeats, runs=shrunk.runs, writes=writes))

    def _report(self, found: FuzzFinding) -> None:
        self.campaign.findings.append(found)
        self.campaign.progress.crashes = len(self._failures)
        self._listener.on_found(found)
