"""Run a campaign: many matches, guided by the goals they reach. Each distinct failure is shrunk and saved once.

Failures are shrunk in processes of their own, beside the matches, which go on (`playing`). Doubtful ones wait until the
matches are over: they may take hundreds of runs, and show nothing.
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
from ..match.work import MOST_RUNS, FuzzTask, MatchResult, NoMoreWork, ReplayTask, ShrinkTask, Shrunk
from ..oracle.failure import WHILE_DISABLED, FuzzFailure
from .corpus import Corpus, found_in
from .describe import story_of
from .executors import WorkExecutor
from .first_starts import START_US, try_starts
from .kept_guidance import read_guidance, write_guidance
from .playing import Match, Playing
from .results import Campaign, CampaignListener, CampaignOptions, FuzzFinding

#: The least time between two writes of what guides the campaign.
_KEPT_EVERY_SECONDS = 5.0

#: How many seconds shrinking one failure may take, in a campaign with a limit of time.
_LEAST_SECONDS, _MOST_SECONDS = 5.0, 60.0

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
    """

    number: int | None
    played: MatchResult

    @property
    def failure(self) -> FuzzFailure:
        assert self.played.failure is not None
        return self.played.failure

    @property
    def key(self) -> tuple[int | None, str]:
        return self.number, self.failure.cause

    @property
    def is_doubtful(self) -> bool:
        """Return whether this may be no fault: lights are set by the same calls as motors."""
        return self.failure.kind == WHILE_DISABLED


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
        self._kept_at = time.monotonic()
        self._playing = Playing(executor.project, options)
        self._failures: list[FuzzFailure] = []
        #: Failures that wait to be shrunk, and those that are being shrunk, by the identity of their task.
        self._waiting: deque[_Failed] = deque()
        self._shrinking: dict[int, tuple[ShrinkTask, _Failed]] = {}
        #: What has been shrunk, or will be, by the match and the cause.
        self._shrunk: dict[tuple[int | None, str], Shrunk | None] = {}
        #: New failures in the order of their matches: they are saved in this order, but for doubtful ones.
        self._to_save: list[_Failed] = []

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
        if self._options.resume:
            self._playing.resume(read_guidance(self._executor.project, self._options.seed, self._options.shard))
        self._playing.over = self._fails_at_start()
        with closing(self._executor.run(self._next_work)) as results:
            for work, result in results:
                if isinstance(result, Shrunk):
                    self._on_shrunk(self._shrinking.pop(id(work))[1], result)
                elif isinstance(work, FuzzTask):
                    for match, played in self._playing.finish(work, result):
                        self._learn(match, played)
                self._listener.on_progress(self.campaign.progress)

    def _fails_at_start(self) -> bool:
        """Return whether the robot fails at its start in any case, as it would in every match; report it."""
        starts = try_starts(self._executor)
        if starts.seconds >= REPORTED_AFTER:
            print(f"each match begins with about {starts.seconds:.0f} s of starting this robot", file=sys.stderr)
        self._playing.known_of_robot = replace(
            self._playing.known_of_robot,
            published=starts.published,
            always_set=tuple(starts.always_set),
            overrides=starts.overrides,
        )
        hints = self.campaign.hints
        hints.always_set += [failure.place for failure in starts.always_set.values()]
        hints.starts += starts.count
        hints.failed_starts.update(starts.failed)
        for failure in starts.unsteady:
            self._note_unsteady(failure)
        if starts.always_fails is None:
            return False
        self.campaign.always_fails = starts.count
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
        may_begin = self._waiting and (is_only_shrunk or not self._waiting[0].is_doubtful)
        if may_begin and len(self._shrinking) < (jobs if is_only_shrunk else max(1, jobs // 2)):
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
            seconds = max(_LEAST_SECONDS, min(_MOST_SECONDS, left / (2 + len(self._waiting))))
        task = ShrinkTask(failed.played.script, failed.failure, failed.played.inputs, most_runs, seconds)
        self._shrinking[id(task)] = task, failed
        self._count_shrinking()
        return task

    def _end_batch(self) -> bool:
        """Return whether the next batch may begin: when it is known which frequent failures it avoids."""
        is_complete = True
        for number, played in self._playing.frequent_failures():
            failed = _Failed(number, played)
            if failed.key not in self._shrunk:
                self._wait(failed)
            shrunk = self._shrunk[failed.key]
            if shrunk is None:
                is_complete = False
            elif shrunk.repeats:
                self._playing.scheduler.avoid(shrunk.failure, shrunk.script)
        return is_complete

    def _wait(self, failed: _Failed) -> None:
        """Have a failure shrunk: after those that wait, but before doubtful ones."""
        self._shrunk[failed.key] = None
        self._waiting.append(failed)
        self._waiting = deque(sorted(self._waiting, key=lambda each: each.is_doubtful))

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
        self.campaign.hints.add(played.hints)
        self.campaign.unrepeatable = self.campaign.unrepeatable or played.unrepeatable
        progress.matches += 1
        progress.simulated += played.script.end_us / 1e6
        progress.cost = self._playing.cost
        if reached := self._playing.reached:
            lines = self._all_lines
            progress.covered = len(lines.intersection(reached)) / len(lines) if lines else 1.0
        for each in played.each_failure():
            self._note_failure(match.number, each)
        if time.monotonic() - self._kept_at > _KEPT_EVERY_SECONDS:
            self.keep_guidance()

    def _note_failure(self, number: int | None, played: MatchResult) -> None:
        if played.failure is None:
            return
        hints, cause = self.campaign.hints, played.failure.cause
        hints.failed_starts[cause] += played.script.end_us <= START_US
        if cause in hints.unsteady or not self._is_new(played.failure):
            return
        failed = _Failed(number, played)
        self._wait(failed)
        self._to_save.append(failed)
        self.campaign.progress.crashes = len(self._failures)
        self._listener.on_seen(failed.failure)

    def _on_shrunk(self, failed: _Failed, shrunk: Shrunk) -> None:
        self._shrunk[failed.key] = shrunk
        if shrunk.repeats and not self._playing.in_batches and not failed.played.went_on:
            self._playing.scheduler.avoid(shrunk.failure, shrunk.script)
        self._count_shrinking()
        for each in list(self._to_save):
            if (done := self._shrunk[each.key]) is not None:
                self._to_save.remove(each)
                self._save(each, done)
            elif not each.is_doubtful:
                break

    def _count_shrinking(self) -> None:
        number = len(self._shrinking) + len(self._waiting)
        self.campaign.progress.doing = f"shrinking {counted(number, 'script')}" if number else ""

    def keep_guidance(self) -> None:
        """Keep which matches were worth continuing."""
        options = self._options
        if self.campaign.progress.simulated and not options.recorded:
            write_guidance(self._executor.project, options.seed, options.shard, self._playing.kept())
        self._kept_at = time.monotonic()

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
            if self.campaign.always_fails:  # not in each start, after all
                self.campaign.always_fails, self._playing.over = 0, False
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
