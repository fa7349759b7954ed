"""Run one match in its own process, with generated inputs or those of a script, and return the result."""

from __future__ import annotations

import random
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from contextlib import closing as closed
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from ...errors import PyfrcError
from ...invariants.watch import BrokenInvariantError, watch_invariants
from ...physics.construct import construct
from ...project import Project
from ...runtime.checks.crash_moment import CrashMoment
from ...runtime.checks.hang_detector import HangDetector
from ...runtime.checks.loop_limit import LoopLimit
from ...runtime.clock import PACKET_US, to_us
from ...runtime.exceptions import TestEnded, TestRanTooLong
from ...runtime.real_time_pace import RealTimePace
from ...runtime.robot import RobotRun
from ...runtime.scripts.boots import PersistentEntry, boots_of, restore_entries, what_stays, without_entries
from ...runtime.scripts.files import traced
from ...runtime.scripts.player import Player
from ...runtime.scripts.script import InputScript, ScriptError, Step
from ...runtime.scripts.targets import RESTART, Targets
from ...runtime.seeds import seed_generators
from ...runtime.turns import acquire
from ...wpi import network
from ..guidance.goals import Goal
from ..guidance.seed_schedule import match_seconds
from ..guidance.states import RobotStates
from ..inputs.asked_controls import watch_controls
from ..inputs.input_generator import InputGenerator
from ..inputs.match_plan import MODE_FUNCTIONS, MatchEvent, haste_of, plan_match
from ..inputs.network_reads import watch_network_reads
from ..inputs.values import Value
from ..oracle.checks import attach_oracle
from ..oracle.failure import ALWAYS_SET, FuzzFailure, failure_of
from ..oracle.hints import HintWatch, threads_left
from ..oracle.misbehavior_notes import MisbehaviorNotes
from .imported_robot import (
    imported_devices,
    invariants_of,
    load,
    robot_constants,
    robot_lines,
)
from .journal import Journal
from .restarts import play_parts
from .work import FuzzTask, MatchResult, ReplayTask, Restart, Task

if TYPE_CHECKING:
    from ...processes.crash_report import CrashLog

_PLAIN_TYPES = ("boolean", "int", "float", "double", "string")


def play(project: Project, log: CrashLog, task: Task) -> MatchResult:
    """Run one task in this process, which must end afterwards.

    :param log: where to write a crash report when the robot's code cannot be stopped
    """
    acquire()
    if isinstance(task, ReplayTask):
        if len(boots_of(task.script)) > 1:
            return play_parts(project, partial(_replay, task=task), task.quietly)
        return _replay(project, log, None, task)
    start = _plan(project, task)
    if any(RESTART in event.writes for event in start.plan):
        played = play_parts(project, partial(_fuzz, task=task))
    else:
        played = _fuzz(project, log, None, task, start)
    if played.failure is not None or played.noted:
        return played
    return replace(played, script=replace(played.script, steps=()), inputs={})  # they are not needed


class _Start(NamedTuple):
    """The start of a match: its random numbers, from which its plan has been drawn, and the plan."""

    rng: random.Random
    plan: list[MatchEvent]


def _plan(project: Project, task: FuzzTask) -> _Start:
    rng = task.schedule.rng()
    if task.schedule.base is not None:
        return _Start(rng, task.schedule.base.plan())
    seconds = match_seconds(project, task.schedule)
    messages = project.game_specific_messages
    return _Start(rng, plan_match(rng, seconds, project.settings.match, messages, task.overrides))


def _fuzz(
    project: Project, log: CrashLog, before: MatchResult | None, task: FuzzTask, start: _Start | None = None
) -> MatchResult:
    """Play a match, or one part of it.

    :param before: the result of the parts before
    :param start: the start of the match, if it is known
    """
    lines = robot_lines(project)
    seconds = match_seconds(project, task.schedule)
    ends_us = to_us(seconds)
    if (continued_us := task.schedule.seeds[-1][0]) > 0:  # a match that continues a long one is not as long again
        ends_us = min(ends_us, continued_us + to_us(project.settings.fuzz.match_seconds))
    rng, plan = start or _plan(project, task)
    begin = _restart_after(before)
    before_us = begin.at_us
    reseed_until_us = task.schedule.seeds[-1][0] + PACKET_US
    with _robot(project, log, task.schedule.robot_seed, begin, task.always_set) as (run, notes), ExitStack() as closing:
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
            auto_joysticks=project.auto_joysticks,
            haste=haste_of(task.schedule.seeds[0][1]),
        )
        generator.left_out = task.schedule.left_out_at(begin.at_us)
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
        watched: AbstractContextManager[Mapping[Goal, int]] = nullcontext({})
        if task.watches_lines:
            watched = lines.watched(task.known, lambda: clock.now_us)
        with watched as reached:
            try:
                construct(project, run, load(project))
                if before is None:
                    fuzz_run.write()
                else:
                    generator.resume(begin.at_us)
                    rng.setstate(begin.rng_state)
                    fuzz_run.resume(before.script.steps, begin.entries)
                run.start()
                watch.measure_loops()
                run.run_until(clock.limit_us + 1)
            except (TestEnded, TestRanTooLong):
                pass
            except BaseException as error:  # robot code may call exit(), too
                failure = failure_of(error, project.files)
        script = fuzz_run.script(project.main_file.name, task.schedule.robot_seed)
        script = script.with_found(ALWAYS_SET, task.always_set)
        unrepeatable = run.hal_data["CAN"].unrepeatable_devices()
        restarts = fuzz_run.restarts and failure is None and run.clock.now_us < ends_us
        restart = Restart.after(begin.number, run.clock.now_us, rng.getstate()) if restarts else None
        hints = watch.hints()
        if failure is None and not restarts:
            hints = replace(hints, threads=threads_left(run))
        played = MatchResult(
            failure,
            script,
            dict(reached) | states.reached,
            generator.inputs,
            unrepeatable,
            tuple(notes.found),
            hints=hints,
            restart=restart,
            names=dict(states.names),
        )
        return played.with_parts_before(before)


def _restart_after(before: MatchResult | None) -> Restart:
    return before.restart if before is not None and before.restart is not None else Restart(0, 0, ())


def _replay(project: Project, log: CrashLog, before: MatchResult | None, task: ReplayTask) -> MatchResult:
    """Replay a script, or the part of it that belongs to one part.

    :param before: the result of the parts before
    """
    begin = _restart_after(before)
    parts = boots_of(task.script)
    script, is_last = parts[begin.number], begin.number == len(parts) - 1
    if begin.number:
        sent_again = replace(script.steps[0], writes=without_entries(script.steps[0].writes, begin.entries))
        script = replace(script, steps=(sent_again, *script.steps[1:]))
    oracle = task.use_oracle, task.ends_with
    always_set = task.script.found.get(ALWAYS_SET, ())
    robot = _robot(
        project, log, script.seed, begin, always_set, *oracle, hang_seconds=task.hang_seconds, paced=task.paced
    )
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
        restart = Restart.after(begin.number, script.end_us) if may_go_on and failure is None else None
        result = MatchResult(
            failure,
            played,
            noted=tuple(notes.found),
            restart=restart,
            published=_published(),
            overrides=_overrides(project),
        )
        return result.with_parts_before(before)


def _overrides(project: Project) -> tuple[str, ...]:
    """Return the functions for modes that the robot's class has, and that do something."""
    codes = {name: getattr(getattr(load(project), name, None), "__code__", None) for name in MODE_FUNCTIONS}
    return tuple(
        name
        for name, code in codes.items()
        if code is not None and code.co_names and project.files.is_robot_code(code.co_filename)
    )


def _published() -> frozenset[str]:
    """Return the entries of NetworkTables that are lists or structs: dashboards let no one change these."""
    return frozenset(name for name, type_name in network.entries() if type_name not in _PLAIN_TYPES)


@contextmanager
def _robot(
    project: Project,
    log: CrashLog,
    seed: int,
    begin: Restart,
    always_set: Collection[str],
    use_oracle: bool = True,
    ends_with: FuzzFailure | None = None,
    hang_seconds: float | None = None,
    paced: bool = False,
) -> Iterator[tuple[RobotRun, MisbehaviorNotes]]:
    """Open a run with hang detection and, by default, the oracle. The run is never closed: its process ends."""
    # Imports the robot before robot time begins.
    run = RobotRun(has_devices=imported_devices(project), start_us=begin.at_us)
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
            closing.callback(run.data_logs.close)
            if use_oracle:
                closing.enter_context(attach_oracle(run, project.files, settings, notes.ends_run, always_set))

            def on_broken(error: BrokenInvariantError) -> None:
                if not use_oracle or notes.ends_run(error):
                    run.threads.fail(error)

            watch_invariants(run, project.files, invariants_of(project), on_broken)
            seed_generators(seed)
            restore_entries(begin.entries)
            yield run, notes


class FuzzRun:
    """Writes generated inputs to a run.

    :param run: the robot has been constructed, and not started
    :param generator: generates the inputs
    :param journal: where each step is written before it is applied
    """

    def __init__(self, run: RobotRun, generator: InputGenerator, journal: Journal | None = None) -> None:
        self.steps: list[Step] = []
        self._run = run
        self._generator = generator
        self._journal = journal
        #: Whether inputs may be left out that this robot does not have: a recorded match may be another robot's.
        self.may_lack_targets = False
        #: Whether the robot program is started again now: the run ends.
        self.restarts = False
        self._targets = Targets(run.hal_data, run.connection.packet)
        run.at_close(self._targets.close)
        generator.write_at_once = self._apply

    def write(self) -> None:
        """Write the inputs that are due now; call it once before the robot starts."""
        writes = self._generator.writes(self._run.clock.now_us)
        if writes:
            self._apply(writes)

    def resume(self, steps: Iterable[Step], entries: Iterable[PersistentEntry]) -> None:
        """Go on after these steps of the parts before; call it once before the robot starts.

        :param entries: the persistent entries of NetworkTables that those have left
        """
        self.steps = list(steps)
        now_us = self._run.clock.now_us
        stays = what_stays([step for step in self.steps if step.at_us < now_us], now_us)
        for target, value in (without_entries(stays, entries) | dict(self.steps[-1].writes)).items():
            if target != RESTART:
                self._targets.write(target, value, now_us)

    def on_packet(self, now: float) -> bool:
        """Write the inputs of the next packet; return whether the match continues."""
        now_us = self._run.clock.now_us
        if now_us >= self._generator.next_us:
            self.write()
        self._targets.count_down(now_us)
        return not self.restarts and not self._generator.over(now_us)

    def _apply(self, writes: Mapping[str, Value]) -> None:
        now_us = self._run.clock.now_us
        if self.may_lack_targets:
            writes = {target: value for target, value in writes.items() if self._is_there(target)}
        self.steps.append(Step(now_us, writes))
        if self._journal is not None:
            self._journal.add(self.steps[-1])
        if writes.get(RESTART):
            self.restarts = True
            return
        for target, value in writes.items():
            self._targets.write(target, value, now_us)

    def _is_there(self, target: str) -> bool:
        try:
            self._targets.check(target)
            self._targets.check_made(target)
        except (PyfrcError, LookupError, TypeError):
            return False
        return True

    def script(self, robot: str, seed: int) -> InputScript:
        """Return the inputs up to now as a script that ends after this packet."""
        return InputScript(tuple(self.steps), self._run.clock.now_us + PACKET_US, robot=robot, seed=seed)
