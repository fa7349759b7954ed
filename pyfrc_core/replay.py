"""`pyfrc replay`: run the robot with the inputs of a script, and compare its trace with the recorded one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from .errors import PyfrcError, RobotCodeError
from .interruption import interruption
from .invariants.load import load_invariants
from .invariants.watch import watch_invariants
from .physics.construct import construct
from .processes.lent_streams import lent_streams
from .project import Project
from .runtime.checks.failures import as_robot_code_error
from .runtime.checks.hang_detector import HangDetector
from .runtime.checks.loop_limit import LoopLimit
from .runtime.clock import to_us
from .runtime.loading import load_robot
from .runtime.patches.data_logs import LogPlace
from .runtime.patches.install import patches
from .runtime.real_time_pace import RealTimePace
from .runtime.robot import RobotRun
from .runtime.scripts.boots import boots_of
from .runtime.scripts.files import traced
from .runtime.scripts.inputs_file import load_inputs, remarks
from .runtime.scripts.player import Player
from .runtime.scripts.script import InputScript, trace_beside
from .runtime.scripts.trace_difference import Difference, first_difference
from .runtime.seeds import seed_generators
from .temporary import temporary_directory


@dataclass(frozen=True)
class ReplayResult:
    """Result of a replay.

    :param seconds: how much robot time passed
    :param failure: the exception that the robot's code raised, with its line
    :param digest: the hash of the trace
    :param equal: whether the trace equals the recorded one; None when the recording has no hash
    :param difference: the first difference, if the recording has a trace
    :param unrepeatable: the devices that do not repeat, as `compat.unrepeatable` names them
    :param starts: how many times the script starts the robot program; the trace is that of the last one
    """

    seconds: float
    failure: PyfrcError | None
    digest: str
    equal: bool | None
    difference: Difference | None
    unrepeatable: tuple[str, ...] = ()
    starts: int = 1


def replay(
    project: Project,
    file: Path,
    *,
    until: float | None = None,
    trace: Path | None = None,
    say: Callable[[str], object] = lambda text: None,
) -> ReplayResult:
    """Run the robot with the inputs of the script in `file`.

    :param until: an earlier end, in seconds of robot time; then the trace is compared up to there only
    :param trace: where to write the trace
    :param say: prints what users should know about the file
    :raises ScriptError: when the script is not valid, or does not fit the robot
    :raises InvariantError: when a rule cannot be called
    :raises RobotCodeError: when the robot's code, or a file with rules, cannot be imported
    """
    script = load_inputs(file)
    for remark in remarks(script):
        say(remark)
    if len(boots_of(script)) > 1:
        return _replay_boots(project, script, until, trace)
    if script.story and (ended := _process_failure(project, script)) is not None:
        return ReplayResult(script.end_us / 1_000_000, RobotCodeError(ended), "", None, None)
    return _replay_here(project, script, file, until, trace)


@lent_streams()  # not around other processes, which may have to be quiet
def _replay_here(
    project: Project, script: InputScript, file: Path, until: float | None, trace: Path | None
) -> ReplayResult:
    """Run the robot in this process."""
    from .fuzz.oracle.checks import oracle_if_fuzzed

    patches.install(project.files)
    robot_class = load_robot(project)
    rules = load_invariants(project)
    until_us = None if until is None else to_us(until)
    with temporary_directory("replay") as temporary:
        written = trace or Path(temporary, "trace.jsonl")
        run = RobotRun(LogPlace.of_run(project.root))
        failures: list[PyfrcError] = []
        settings = project.settings
        hang_seconds = settings.fuzz.hang_seconds if script.story else settings.test.hang_seconds
        with HangDetector(project.files, hang_seconds, meanwhile="the replay").watching():
            run.open()
            LoopLimit(run, project.files, settings)
            RealTimePace(run, settings)
            try:
                watch_invariants(run, project.files, rules)
                seed_generators(script.seed)
                with oracle_if_fuzzed(run, project, script), traced(run, written) as recorder:
                    with _collected(failures, project):
                        construct(project, run, robot_class)
                        Player(script, run).play(until_us)
                    seconds = run.clock.now
                    unrepeatable = run.hal_data["CAN"].unrepeatable_devices()
            finally:
                with _collected(failures, project):
                    run.close()
        beside = trace_beside(file)
        difference = first_difference(beside, written, run_us=until_us) if beside.is_file() else None
    whole = until_us is None or until_us >= script.end_us
    equal = None
    if script.trace and whole:
        # The same values have another hash if another version of pyfrc or pydantic wrote their numbers in another form.
        equal = script.trace == recorder.digest() or (beside.is_file() and difference is None)
    return ReplayResult(seconds, failures[0] if failures else None, recorder.digest(), equal, difference, unrepeatable)


def _replay_boots(project: Project, script: InputScript, until: float | None, trace: Path | None) -> ReplayResult:
    """Replay a script in which the robot program is started again; its traces are not compared."""
    from .fuzz.match.replay_in_subprocess import replay_in_subprocess

    end_us = script.end_us if until is None else min(script.end_us, to_us(until))
    try:
        seconds, failure = replay_in_subprocess(project, replace(script, end_us=end_us), trace, quietly=False)
    except RobotCodeError as error:
        seconds, failure = end_us / 1_000_000, error
    return ReplayResult(seconds, failure, "", None, None, starts=len(boots_of(script)))


@contextmanager
def _collected(failures: list[PyfrcError], project: Project) -> Iterator[None]:
    """Collect what robot code raises, including `exit()` and its own `KeyboardInterrupt`, but not Ctrl-C."""
    try:
        yield
    except PyfrcError:
        raise
    except BaseException as error:
        interruption.check(error)
        failures.append(as_robot_code_error(error, project.files))


def _process_failure(project: Project, script: InputScript) -> str | None:
    """Return how the process ends with a script of `pyfrc fuzz` that is known to end it; run in a separate process."""
    from .fuzz.campaign.executors import open_match_executor
    from .fuzz.oracle.failure import PROCESS_ENDED

    with open_match_executor(project, jobs=1) as executor:
        failure = executor.replay(script).failure
    return failure.text if failure is not None and failure.kind == PROCESS_ENDED else None
