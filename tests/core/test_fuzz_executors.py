"""How matches are begun, in which order they are yielded, and what is left of one whose process has died."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.errors import RobotCodeError
from pyfrc_core.fuzz.campaign import executors
from pyfrc_core.fuzz.campaign.executors import LocalMatchExecutor
from pyfrc_core.fuzz.guidance.seed_schedule import SeedSchedule
from pyfrc_core.fuzz.match import imported_robot
from pyfrc_core.fuzz.match.imported_robot import import_libraries
from pyfrc_core.fuzz.match.journal import Journal
from pyfrc_core.fuzz.match.work import FuzzTask, MatchResult, NoMoreWork, ReplayTask, ShrinkTask, Shrunk, Work
from pyfrc_core.fuzz.oracle.failure import HANGS, PROCESS_ENDED, FuzzFailure, NotedFailure
from pyfrc_core.processes.crash_report import CrashLog
from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts.script import InputScript, Step

FAILURE = FuzzFailure("ValueError", "robot.py:1", "f", "robot.py:1: ValueError")


def script(end_us: int) -> InputScript:
    return InputScript((), end_us)


def replay(end_us: int) -> ReplayTask:
    return ReplayTask(script(end_us))


def result(end_us: int) -> MatchResult:
    return MatchResult(None, script(end_us))


class Call:
    """A process: it has finished when it is in `ends`, and then returns `outcome`."""

    def __init__(self, task: Work, outcome: object) -> None:
        self.task, self.outcome = task, outcome
        self.finished = False
        self.closed = 0

    def result(self, files: object, meanwhile: str) -> Any:
        assert self.finished
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome

    def close(self) -> None:
        self.closed += 1


class Local(LocalMatchExecutor):
    """Its processes end in the order of `ends`: one number, the how-manieth that was begun, for each wait."""

    def __init__(self, directory: Path, jobs: int = 2) -> None:
        super().__init__(Project(directory / "robot.py"), jobs, directory)
        self.lines = frozenset()
        self.begun: list[Call] = []
        self.ends: Iterator[int] = iter(())
        self.outcome: Callable[[Any], object] = lambda task: MatchResult(None, task.script)

    def _begin(self, task: Work) -> Any:
        self.begun.append(Call(task, self.outcome(task)))
        return self.begun[-1]

    def wait(self, calls: list[Call]) -> None:
        self.begun[next(self.ends)].finished = True

    def close(self) -> None: ...


@pytest.fixture
def local(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Local:
    made = Local(tmp_path)
    monkeypatch.setattr(executors, "wait_for_calls", made.wait)
    return made


def ends_of(results: Iterator[MatchResult]) -> list[int]:
    return [each.script.end_us for each in results]


def test_the_libraries_of_a_robot_are_not_its_own_modules(tmp_path: Path) -> None:
    (tmp_path / "robot.py").write_text(
        "import html.parser\nimport wpilib\nimport parts\nclass MyRobot(wpilib.TimedRobot):\n    pass\n"
    )
    (tmp_path / "parts.py").write_text("")
    code = (
        "from pathlib import Path; from pyfrc_core.project import Project; "
        "from pyfrc_core.fuzz.match.imported_robot import libraries_of; "
        "print(*libraries_of(Project(Path('robot.py').resolve())))"
    )
    names = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True).stdout.split()
    assert "html.parser" in names
    assert not {"robot", "parts"}.intersection(names)


def test_a_process_that_has_imported_libraries_may_be_forked_unless_they_started_threads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reasons: list[str] = []
    monkeypatch.setattr(imported_robot, "reasons_not_to_fork", lambda: reasons)
    monkeypatch.setattr(imported_robot.patches, "install", lambda files: None)
    monkeypatch.setattr(imported_robot.library_threads, "begin", lambda: None)
    project = Project(tmp_path / "robot.py")
    assert import_libraries(project, ["html.parser", "no.such.library"])
    reasons.append("a thread")
    assert not import_libraries(project, [])


def test_a_process_returns_the_lines_of_the_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lines = frozenset({("robot.py", 1)})
    monkeypatch.setattr(executors, "robot_lines", lambda project: SimpleNamespace(all=lines))
    assert executors.all_lines(Project(tmp_path / "robot.py"), CrashLog(0)) == lines


def test_results_come_in_the_order_of_the_tasks_and_no_more_run_than_there_are_jobs(local: Local) -> None:
    local.ends = iter([1, 2, 0, 3])
    counts: list[int] = []

    def outcome(task: Any) -> object:
        counts.append(sum(not each.closed for each in local.begun) + 1)
        return MatchResult(None, task.script)

    local.outcome = outcome
    assert ends_of(local.play([replay(number) for number in (10, 20, 30, 40)])) == [10, 20, 30, 40]
    assert max(counts) == 2
    assert [each.closed for each in local.begun] == [1] * 4


def test_equal_tasks_keep_their_results_apart(local: Local) -> None:
    same = replay(10)
    numbers = iter([1, 2])
    local.outcome = lambda task: result(next(numbers))
    local.ends = iter([1, 0])
    assert ends_of(local.play([same, replay(10)])) == [1, 2]


def test_closing_ends_what_runs(local: Local) -> None:
    local.ends = iter([0])
    with closing(local.play([replay(number) for number in range(9)])) as results:
        assert next(results).script.end_us == 0
    assert len(local.begun) <= 3
    assert [each.closed for each in local.begun] == [1] * len(local.begun)


def test_an_interrupt_ends_what_runs(local: Local) -> None:
    local.ends = iter([0, 1, 2])
    results = local.play([replay(number) for number in range(9)])
    next(results)
    local.interrupted = True
    with pytest.raises(KeyboardInterrupt):
        next(results)
    assert [each.closed for each in local.begun] == [1] * len(local.begun)


def test_a_match_that_the_interrupt_has_ended_is_no_result(local: Local, monkeypatch: pytest.MonkeyPatch) -> None:
    def wait(calls: list[Call]) -> None:
        local.begun[0].finished = local.interrupted = True

    local.outcome = lambda task: RobotCodeError("the process ended by signal 15 (SIGTERM)")
    monkeypatch.setattr(executors, "wait_for_calls", wait)
    with pytest.raises(KeyboardInterrupt):
        next(local.play([replay(1)]))
    assert [each.closed for each in local.begun] == [1]


def test_no_more_work_ends_without_the_results_that_are_missing(local: Local) -> None:
    works: list[Work | Exception | None] = [replay(1), replay(2), None, NoMoreWork()]
    local.ends = iter([0])

    def next_work() -> Work | None:
        each = works.pop(0)
        if isinstance(each, Exception):
            raise each
        return each

    assert [found.script.end_us for _, found in local.run(next_work)] == [1]
    assert [each.closed for each in local.begun] == [1, 1]


# -- processes that die ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "kind", "place"),
    [
        ("robot.py:7: the process ended with code 3\nmore", PROCESS_ENDED, "robot.py:7"),
        ("robot.py:7: teleopPeriodic hangs here for 10 s", HANGS, "robot.py:7"),
        ("the process was killed", PROCESS_ENDED, ""),
    ],
)
def test_the_failure_of_a_process_that_died(local: Local, text: str, kind: str, place: str) -> None:
    local.outcome = lambda task: RobotCodeError(text)
    local.ends = iter([0])
    (found,) = local.play([replay(50)])
    assert found.failure == FuzzFailure(kind, place, "", text.partition("\n")[0])
    assert found.script.end_us == 50


def test_the_inputs_of_a_match_that_died_are_those_of_its_journal(local: Local, tmp_path: Path) -> None:
    steps = (Step(0, {"mode": "teleop"}), Step(20_000, {"dio[1].value": True}))

    def outcome(task: Any) -> object:
        with closing(Journal(task.journal)) as journal:
            for step in steps:
                journal.add(step)
        return RobotCodeError("robot.py:7: the process ended")

    local.outcome = outcome
    local.ends = iter([0, 1])
    task = FuzzTask(SeedSchedule(((0, "1"),)))
    first, second = local.play([task, task])
    assert (first.script.steps, second.script.steps) == (steps, steps)
    assert first.script.robot == "robot.py"
    assert first.script.end_us > 20_000
    journals = [each.task.journal for each in local.begun if isinstance(each.task, FuzzTask)]
    assert len(set(journals)) == 2
    assert not any(each is not None and each.exists() for each in journals)
    assert task.journal is None


def test_a_failure_after_which_a_match_went_on_has_the_inputs_until_then() -> None:
    steps = tuple(Step(at_us, {"dio[0].value": True}) for at_us in (0, 40_000, 80_000))
    played = MatchResult(FAILURE, InputScript(steps, 100_000), noted=(NotedFailure(FAILURE, 40_000),))
    first, last = played.each_failure()
    assert (first.script, first.went_on) == (InputScript(steps[:1], 40_000), True)
    assert (last.script, last.went_on, last.noted) == (played.script, False, ())


def test_a_process_that_died_while_it_made_a_script_short_leaves_the_long_one(local: Local) -> None:
    local.outcome = lambda task: RobotCodeError("robot.py:7: the process ended")
    local.ends = iter([0])
    task = ShrinkTask(script(70), FAILURE)
    works: list[Work] = [task]
    ((given, found),) = local.run(lambda: works.pop() if works else None)
    assert (given, found) == (task, Shrunk(script(70), FAILURE))
