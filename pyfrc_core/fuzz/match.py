"""Run one match in its own process, with generated inputs or those of a script, and return the result."""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from contextlib import closing as closed
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import ntcore

from ..invariants.watch import BrokenInvariantError, watch_invariants
from ..physics.construct import construct
from ..project import Project
from ..runtime.checks.crash_moment import CrashMoment
from ..runtime.checks.hang_detector import HangDetector
from ..runtime.checks.loop_limit import LoopLimit
from ..runtime.clock import PACKET_US, to_us
from ..runtime.exceptions import TestEnded, TestRanTooLong
from ..runtime.real_time_pace import RealTimePace
from ..runtime.robot import RobotRun
from ..runtime.scripts.boots import boots_of, restore_entries, without_entries
from ..runtime.scripts.files import traced
from ..runtime.scripts.player import Player
from ..runtime.scripts.script import InputScript, ScriptError
from ..runtime.scripts.targets import RESTART
from ..runtime.seeds import seed_generators
from ..runtime.turns import take
from .asked_controls import watch_controls
from .boots import NextBoot, play_boots
from .failure import FuzzFailure, failure_of
from .fuzz_run import FuzzRun
from .goals import Goal
from .imported_robot import (
    auto_joysticks,
    game_messages,
    imported_devices,
    invariants_of,
    load,
    next_tree,
    robot_constants,
    robot_lines,
)
from .input_generator import InputGenerator
from .inputs import Input
from .journal import Journal
from .match_hints import HintWatch, MatchHints
from .match_plan import MatchEvent, length_of, plan_match
from .misbehavior_notes import MisbehaviorNotes, NotedFailure
from .network_reads import watch_network_reads
from .oracle import attach_oracle
from .seed_schedule import SeedSchedule
from .states import RobotStates

if TYPE_CHECKING:
    from ..processes.crash_report import CrashLog

_PLAIN_TYPES = ("boolean", "int", "float", "double", "string")

#: The seed of the robot's own random generators. It is the default seed of tests, so that a script has the same effect
#: there.
ROBOT_SEED = 0


@dataclass(frozen=True)
class FuzzTask:
    """Run a match with generated inputs.

    :param schedule: the random seeds
    :param known: the goals that were reached before
    :param returns_inputs: whether the script and the inputs are returned even if nothing has failed
    :param published: entries of NetworkTables that the program is known to write all the time
    :param journal: a file for the inputs, in case the process ends before it can return them
    """

    schedule: SeedSchedule
    known: frozenset[Goal] = frozenset()
    returns_inputs: bool = True
    published: frozenset[str] = frozenset()
    journal: Path | None = None


@dataclass(frozen=True)
class ReplayTask:
    """Run the robot with the inputs of a script.

    :param use_oracle: whether misbehavior without an exception is a failure
    :param ends_with: misbehavior that ends the run; other misbehavior is noted
    :param hang_seconds: processor seconds without progress that count as a hang; None: those of the project's settings
    :param trace: where to write a trace; with restarts of the robot program, that of the last boot
    :param ignores_missing: whether writes to devices that the robot does not have end the run without a failure
    :param quietly: whether nothing that the boots of a match with restarts print is shown
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
    :param next_boot: what the next boot of the robot program needs; None if the match is over
    :param published: of a replay, the entries of NetworkTables at its end that are no plain values: no one has written
        them but the program
    :param names: the names of the robot's sensors, see `device_names`
    """

    failure: FuzzFailure | None
    script: InputScript
    reached: dict[Goal, int] = field(default_factory=dict)
    inputs: dict[str, Input] = field(default_factory=dict)
    unrepeatable: tuple[str, ...] = ()
    noted: tuple[NotedFailure, ...] = ()
    went_on: bool = False
    hints: MatchHints = field(default_factory=MatchHints)
    next_boot: NextBoot | None = None
    published: frozenset[str] = frozenset()
    names: dict[str, str] = field(default_factory=dict)

    def each_failure(self) -> Iterator[MatchResult]:
        """Return a result for each failure, in order, with the inputs until it."""
        for failure, end_us in self.noted:
            steps = tuple(step for step in self.script.steps if step.at_us < end_us)
            script = replace(self.script, steps=steps, end_us=min(end_us, self.script.end_us))
            yield replace(self, failure=failure, script=script, noted=(), went_on=True)
        if self.failure is not None:
            yield replace(self, noted=())


def play(project: Project, log: CrashLog, task: Task) -> MatchResult:
    """Run one task in this process, which must end afterwards.

    :param log: where to write a crash report when the robot's code cannot be stopped
    """
    take()
    if isinstance(task, ReplayTask):
        if len(boots_of(task.script)) > 1:
            replayed: MatchResult = play_boots(project, partial(_replay, task=task), task.quietly)
            return replayed
        return _replay(project, log, None, task)
    start = _plan(project, task.schedule)
    if any(RESTART in event.writes for event in start.plan):
        played: MatchResult = play_boots(project, partial(_fuzz, task=task))
    else:
        played = _fuzz(project, log, None, task, start)
    if task.returns_inputs or played.failure is not None or played.noted:
        return played
    return replace(played, script=replace(played.script, steps=()), inputs={})  # they are not needed


def match_seconds(project: Project, schedule: SeedSchedule) -> float:
    """Return the length of a match with this schedule, in seconds."""
    if schedule.base is not None:
        return schedule.base.end_us(to_us(project.settings.fuzz.match_seconds)) / 1_000_000
    return length_of(schedule.seeds[0][1], project.settings.fuzz.match_seconds, project.settings.match)


class _Start(NamedTuple):
    """The start of a match: its random numbers, from which its plan has been drawn, and the plan."""

    rng: random.Random
    plan: list[MatchEvent]


def _plan(project: Project, schedule: SeedSchedule) -> _Start:
    rng = schedule.rng()
    if schedule.base is not None:
        return _Start(rng, schedule.base.plan())
    seconds = match_seconds(project, schedule)
    return _Start(rng, plan_match(rng, seconds, project.settings.match, game_messages(project)))


def _fuzz(
    project: Project, log: CrashLog, before: MatchResult | None, task: FuzzTask, start: _Start | None = None
) -> MatchResult:
    """Play a match, or one boot of it.

    :param before: the result of the boots before
    :param start: the start of the match, if it is known
    """
    lines = robot_lines(project)
    seconds = match_seconds(project, task.schedule)
    ends_us = to_us(seconds)
    if (continued_us := task.schedule.seeds[-1][0]) > 0:  # a match that continues a long one is not as long again
        ends_us = min(ends_us, continued_us + to_us(project.settings.fuzz.match_seconds))
    rng, plan = start or _plan(project, task.schedule)
    boot = _boot_after(before)
    before_us = boot.at_us
    reseed_until_us = task.schedule.seeds[-1][0] + PACKET_US
    with _robot(project, log, ROBOT_SEED, boot) as (run, notes), ExitStack() as closing:
        generator = InputGenerator(
            rng,
            run,
            seconds=seconds,
            plan=plan,
            network_reads=closing.enter_context(watch_network_reads(project.files)),
            constants=robot_constants(project),
            base=task.schedule.base,
            asked_controls=closing.enter_context(watch_controls()).targets,
            published=task.published,
            auto_joysticks=auto_joysticks(project),
        )
        generator.left_out = task.schedule.left_out_at(boot.at_us)
        journal = closing.enter_context(closed(Journal(task.journal))) if task.journal else None
        fuzz_run = FuzzRun(run, generator, journal)
        fuzz_run.may_lack_targets = task.schedule.base is not None
        states = RobotStates(run, project.files, task.known)
        watch = HintWatch(run, project.files, lambda: states.containers)

        def step(now: float) -> None:
            nonlocal before_us
            now_us = clock.now_us
            if now_us <= reseed_until_us:
                task.schedule.reseed(rng, before_us, now_us)
                generator.left_out = task.schedule.left_out_at(now_us)
            before_us = now_us
            states.after_packet(now_us)
            if now_us >= watch.next_us:
                watch.after_packet(now_us)
            if not fuzz_run.on_packet(now) or now_us >= ends_us:
                clock.halted = True

        clock = run.clock
        clock.before_packet.insert(0, step)
        clock.limit_us = max(clock.limit_us, to_us(seconds) + PACKET_US)
        failure = None
        with lines.watched(task.known, lambda: clock.now_us) as reached:
            try:
                construct(project, run, load(project))
                if before is None:
                    fuzz_run.write()
                else:
                    generator.resume(boot.at_us)
                    rng.setstate(boot.rng_state)
                    fuzz_run.resume(before.script.steps, boot.entries)
                run.start()
                watch.measure_loops()
                run.run_until(clock.limit_us + 1)
            except (TestEnded, TestRanTooLong):
                pass
            except BaseException as error:  # robot code may call exit(), too
                failure = failure_of(error, project.files)
        script = fuzz_run.script(project.main_file.name, ROBOT_SEED)
        unrepeatable = run.hal_data["CAN"].unrepeatable_devices()
        restarts = fuzz_run.restarts and failure is None and run.clock.now_us < ends_us
        next_boot = NextBoot.after(boot.number, run.clock.now_us, rng.getstate()) if restarts else None
        played = MatchResult(
            failure,
            script,
            dict(reached) | states.reached,
            generator.inputs,
            unrepeatable,
            tuple(notes.found),
            hints=watch.hints(),
            next_boot=next_boot,
            names=dict(states.names),
        )
        return _joined(before, played)


def _boot_after(before: MatchResult | None) -> NextBoot:
    return before.next_boot if before is not None and before.next_boot is not None else NextBoot(0, 0, ())


def _joined(before: MatchResult | None, played: MatchResult) -> MatchResult:
    """Return the result of a boot with the results of those before."""
    if before is None:
        return played
    return replace(
        played,
        reached=played.reached | before.reached,
        inputs=before.inputs | played.inputs,
        unrepeatable=before.unrepeatable or played.unrepeatable,
        noted=(*before.noted, *played.noted),
    )


def _replay(project: Project, log: CrashLog, before: MatchResult | None, task: ReplayTask) -> MatchResult:
    """Replay a script, or the part of it that belongs to one boot.

    :param before: the result of the boots before
    """
    boot = _boot_after(before)
    boots = boots_of(task.script)
    script, is_last = boots[boot.number], boot.number == len(boots) - 1
    if boot.number:
        sent_again = replace(script.steps[0], writes=without_entries(script.steps[0].writes, boot.entries))
        script = replace(script, steps=(sent_again, *script.steps[1:]))
    oracle = task.use_oracle, task.ends_with
    robot = _robot(project, log, script.seed, boot, *oracle, hang_seconds=task.hang_seconds, paced=task.paced)
    trace = task.trace if is_last else None
    with robot as (run, notes), traced(run, trace) if trace else nullcontext():
        failure, may_go_on = None, not is_last
        try:
            construct(project, run, load(project))
            Player(script, run).play()
        except ScriptError:  # a target does not exist, since the robot has not created it in this run
            if not task.ignores_missing:
                raise
            may_go_on = False
        except (TestEnded, TestRanTooLong):
            pass
        except BaseException as error:  # robot code may call exit(), too
            failure = failure_of(error, project.files)
        end_us = run.clock.now_us + PACKET_US
        steps = tuple(step for step in task.script.steps if step.at_us < end_us)
        played = InputScript(steps, end_us, robot=script.robot, seed=script.seed)
        next_boot = NextBoot.after(boot.number, script.end_us) if may_go_on and failure is None else None
        result = MatchResult(failure, played, noted=tuple(notes.found), next_boot=next_boot, published=_published())
        return _joined(before, result)


def _published() -> frozenset[str]:
    """Return the entries of NetworkTables that are lists or structs: dashboards let no one change these."""
    topics = ntcore.NetworkTableInstance.getDefault().getTopics()
    return frozenset(topic.getName() for topic in topics if topic.getTypeString() not in _PLAIN_TYPES)


@contextmanager
def _robot(
    project: Project,
    log: CrashLog,
    seed: int,
    boot: NextBoot,
    use_oracle: bool = True,
    ends_with: FuzzFailure | None = None,
    hang_seconds: float | None = None,
    paced: bool = False,
) -> Iterator[tuple[RobotRun, MisbehaviorNotes]]:
    """Open a run with hang detection and, by default, the oracle. The run is never closed: its process ends."""
    # Imports the robot before robot time begins.
    run = RobotRun(has_devices=imported_devices(project), start_us=boot.at_us, tree=next_tree())
    settings = project.settings.fuzz
    hang_detector = HangDetector(project.files, hang_seconds or settings.hang_seconds, log)
    with hang_detector.watching():
        run.open()
        CrashMoment(log, run)
        LoopLimit(run, project.files, project.settings)
        if paced:
            RealTimePace(run, project.settings)
        notes = MisbehaviorNotes(run.clock, project.files, ends_with)
        with ExitStack() as closing:
            if use_oracle:
                closing.enter_context(attach_oracle(run, project.files, settings, notes.ends_run))

            def on_broken(error: BrokenInvariantError) -> None:
                if not use_oracle or notes.ends_run(error):
                    run.threads.fail(error)

            watch_invariants(run, project.files, invariants_of(project), on_broken)
            seed_generators(seed)
            restore_entries(boot.entries)
            yield run, notes
