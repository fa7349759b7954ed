"""A campaign without robots: its matches are played by a function, so that its decisions are all that is tested."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pyfrc_core.errors import PyfrcError
from pyfrc_core.fuzz.campaign import campaign as campaigns
from pyfrc_core.fuzz.campaign import first_starts, playing
from pyfrc_core.fuzz.campaign.campaign import run_campaign
from pyfrc_core.fuzz.campaign.corpus import DIRECTORY, NOT_REPEATED
from pyfrc_core.fuzz.campaign.executors import WorkExecutor
from pyfrc_core.fuzz.campaign.first_starts import START_US, STARTS
from pyfrc_core.fuzz.campaign.results import Campaign, CampaignOptions, CampaignProgress, FuzzFinding, Shard
from pyfrc_core.fuzz.guidance.seed_schedule import match_seconds
from pyfrc_core.fuzz.inputs import match_plan
from pyfrc_core.fuzz.match.work import FuzzTask, MatchResult, NoMoreWork, ReplayTask, Result, ShrinkTask, Shrunk, Work
from pyfrc_core.fuzz.oracle.failure import WHILE_DISABLED, FuzzFailure
from pyfrc_core.project import Project
from pyfrc_core.runtime.scripts.script import InputScript, Step

#: The robot's lines.
LINES = frozenset(("robot.py", number) for number in range(10))
MATCH_US = 15_000_000


def failure(line: int) -> FuzzFailure:
    return FuzzFailure("ValueError", f"robot.py:{line}", "f", f"robot.py:{line}: ValueError")


def script(end_us: int = MATCH_US, seed: int = 0) -> InputScript:
    return InputScript((Step(0, {"mode": "teleop"}),), end_us, robot="robot.py", seed=seed)


def passed(*lines: int) -> MatchResult:
    return MatchResult(None, script(), {("robot.py", line): 20_000 for line in lines})


def failed(line: int, end_us: int = MATCH_US) -> MatchResult:
    return MatchResult(failure(line), script(end_us))


class Players(WorkExecutor):
    """Plays in this process.

    :param match: returns the result of the match with this number, counted in the order in which they begin
    """

    def __init__(self, directory: Path, match: Callable[[int], MatchResult], jobs: int = 1) -> None:
        super().__init__(Project(directory / "robot.py"), jobs)
        self.match = match
        self.start: Callable[[ReplayTask], MatchResult] = lambda task: MatchResult(None, task.script)
        self.shrink: Callable[[ShrinkTask], Shrunk] = lambda task: Shrunk(script(40_000), task.failure, True, 7)
        self.tasks: list[Work] = []
        self.begun = 0
        self.lines = LINES

    @property
    def matches(self) -> list[FuzzTask]:
        return [each for each in self.tasks if isinstance(each, FuzzTask)]

    @property
    def shrinkings(self) -> list[ShrinkTask]:
        return [each for each in self.tasks if isinstance(each, ShrinkTask)]

    def interruptible(self) -> AbstractContextManager[None]:
        return nullcontext()

    def run(self, next_work: Callable[[], Work | None]) -> Generator[tuple[Work, Result], None, None]:
        running: deque[tuple[Work, int]] = deque()
        while True:
            try:
                while (task := next_work()) is not None:
                    self.tasks.append(task)
                    running.append((task, self.begun))
                    self.begun += isinstance(task, FuzzTask)
                    assert len(running) <= self.jobs + 1  # a script is made short beside a match
            except NoMoreWork:
                return
            if not running:
                return
            task, number = running.popleft()
            yield task, self._done(task, number)

    def _done(self, task: Work, number: int) -> Result:
        if isinstance(task, FuzzTask):
            return self.match(number)
        return self.shrink(task) if isinstance(task, ShrinkTask) else self.start(task)


class Listener:
    """Notes what a campaign reports."""

    def __init__(self) -> None:
        self.log: list[str] = []
        self.doing: list[str] = []

    def on_seen(self, failure: FuzzFailure) -> None:
        self.log.append(f"seen {failure.place}")

    def on_progress(self, progress: CampaignProgress) -> None:
        self.doing.append(progress.doing)

    def on_found(self, found: FuzzFinding) -> None:
        self.log.append(f"{'known' if found.known else 'found'} {found.failure.place}")


Run = Callable[..., Campaign]


@pytest.fixture
def listener() -> Listener:
    return Listener()


@pytest.fixture
def run(listener: Listener) -> Run:
    def run(players: Players, runs: int | None = 32, seconds: float | None = None, **options: Any) -> Campaign:
        return run_campaign(nullcontext(players), CampaignOptions(1, runs, seconds, players.jobs, **options), listener)

    return run


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "robot.py").write_text("\n" * 20)
    (tmp_path / "tests").mkdir()
    return tmp_path


def saved(project: Path) -> list[str]:
    return sorted(str(file.relative_to(project / "tests" / DIRECTORY)) for file in project.rglob("*.jsonl"))


def test_a_campaign_counts_its_matches_and_the_lines_that_they_reach(project: Path, run: Run) -> None:
    players = Players(project, lambda number: passed(*range(number % 5)))
    done = run(players, runs=20)
    assert (done.progress.matches, done.progress.simulated, done.progress.covered) == (20, 20 * 15.0, 0.4)
    assert (done.findings, done.progress.crashes, done.interrupted, done.always_fails) == ([], 0, False, 0)
    assert len(players.matches) == 20
    assert players.shrinkings == []


def test_the_result_does_not_depend_on_the_number_of_processes(tmp_path: Path, run: Run) -> None:
    schedules = []
    for jobs in (1, 3):
        directory = tmp_path / str(jobs)
        directory.mkdir()
        players = Players(directory, lambda number: passed(number % 10), jobs)
        run(players, runs=64)
        schedules.append([each.schedule for each in players.matches])
    assert schedules[0] == schedules[1]
    assert len({each.seeds for each in schedules[0]}) == 64


def test_machines_that_share_a_campaign_play_different_matches_and_together_all(tmp_path: Path, run: Run) -> None:
    seeds = []
    for number, shard in enumerate((Shard(), Shard(1, 2), Shard(2, 2))):
        directory = tmp_path / str(number)
        directory.mkdir()
        players = Players(directory, lambda number: passed())
        run(players, runs=32, shard=shard)
        seeds.append({each.schedule.seeds for each in players.matches})
    assert (len(seeds[1]), len(seeds[2]), seeds[1] & seeds[2]) == (16, 16, set())
    assert seeds[0] == seeds[1] | seeds[2]


def test_each_failure_is_made_short_and_saved_once_in_the_order_of_the_matches(
    project: Path, run: Run, listener: Listener
) -> None:
    lines = {3: 7, 4: 8, 5: 7, 9: 7}
    players = Players(project, lambda number: failed(lines[number]) if number in lines else passed(), jobs=2)
    done = run(players)
    assert listener.log == ["seen robot.py:7", "seen robot.py:8", "found robot.py:7", "found robot.py:8"]
    assert done.progress.crashes == 2
    assert [each.failure for each in players.shrinkings] == [failure(7), failure(8)]
    assert saved(project) == ["valueerror-robot-f-2.jsonl", "valueerror-robot-f.jsonl"]
    found = done.findings[0]
    assert (found.repeats, found.known, found.runs, found.writes) == (True, False, 7, 1)
    assert found.entry.script.end_us == 40_000
    assert found.entry.script.found["seed"] == 1
    assert {each.entry.script.found["match"] for each in done.findings} <= set(range(32))
    assert any(each.startswith("shrinking ") for each in listener.doing)
    assert listener.doing[-1] == ""
    # The next campaign replays them first, and does not report them again.
    listener.log.clear()
    players = Players(project, lambda number: failed(8) if number == 1 else passed())
    players.start = lambda task: (
        MatchResult(failure(7), task.script) if task.script.end_us == 40_000 else MatchResult(None, task.script)
    )
    done = run(players)
    assert listener.log[0] == "known robot.py:7"
    assert listener.log[1:] == ["seen robot.py:8", "found robot.py:8"]
    assert (done.findings[0].known, len(saved(project))) == (True, 3)


def test_a_failure_that_does_not_repeat_has_the_script_of_the_whole_match(project: Path, run: Run) -> None:
    players = Players(project, lambda number: failed(7) if number == 0 else passed())
    players.shrink = lambda task: Shrunk(task.script, task.failure)
    done = run(players)
    (found,) = done.findings
    assert (found.repeats, found.entry.script.end_us) == (False, MATCH_US)
    assert saved(project) == [f"{NOT_REPEATED}/valueerror-robot-f.jsonl"]


def test_a_failure_right_at_the_start_that_does_not_repeat_is_a_hint(project: Path, run: Run) -> None:
    players = Players(project, lambda number: failed(7, START_US) if number == 0 else passed())
    players.shrink = lambda task: Shrunk(task.script, task.failure)
    done = run(players)
    assert (done.findings, done.progress.crashes, saved(project)) == ([], 0, [])
    assert done.hints.unsteady == {"ValueError robot.py:7": "robot.py:7: ValueError"}
    assert done.hints.failed_starts["ValueError robot.py:7"] == 1


def test_a_robot_that_fails_at_each_start_is_not_played(project: Path, run: Run, listener: Listener) -> None:
    players = Players(project, lambda number: passed())
    players.start = lambda task: failed(7, 20_000)
    done = run(players)
    assert (done.always_fails, done.progress.matches, players.matches) == (2 * STARTS, 0, [])
    assert listener.log == ["seen robot.py:7", "found robot.py:7"]
    assert [each.paced for each in players.tasks if isinstance(each, ReplayTask)] == [False] * STARTS + [True] * STARTS


def test_a_robot_that_fails_at_starts_only_while_the_computer_is_busy_is_played(project: Path, run: Run) -> None:
    players = Players(project, lambda number: failed(7, 20_000) if number % 2 else passed())
    players.start = lambda task: MatchResult(None, task.script) if task.paced else failed(7, 20_000)
    done = run(players)
    assert (done.always_fails, done.findings, done.progress.matches) == (0, [], 32)
    (hint,) = done.hints.texts()
    assert hint.startswith(f"robot.py:7: ValueError (at {STARTS + 16} of {2 * STARTS + 32} starts")


def test_a_campaign_goes_on_if_a_failure_of_each_start_does_not_repeat(project: Path, run: Run) -> None:
    players = Players(project, lambda number: passed())
    players.start = lambda task: failed(7, 20_000)
    players.shrink = lambda task: Shrunk(task.script, task.failure)
    done = run(players)
    assert (done.always_fails, done.findings, done.progress.matches) == (0, [], 32)
    assert list(done.hints.unsteady) == ["ValueError robot.py:7"]


def test_a_start_that_fails_sometimes_is_a_hint_and_the_campaign_goes_on(project: Path, run: Run) -> None:
    starts: list[int] = []

    def start(task: ReplayTask) -> MatchResult:
        starts.append(task.script.seed)
        return failed(7, 20_000) if len(starts) == 2 else MatchResult(None, task.script)

    players = Players(project, lambda number: failed(7, 20_000) if number == 3 else passed())
    players.start = start
    done = run(players)
    assert starts == [*range(STARTS), 1]  # the one that has failed, again
    assert (done.always_fails, done.findings, done.progress.matches) == (0, [], 32)
    assert done.hints.failed_starts["ValueError robot.py:7"] == 2
    assert list(done.hints.unsteady) == ["ValueError robot.py:7"]


def test_what_was_found_is_saved_as_it_is_when_the_user_interrupts(project: Path, run: Run, listener: Listener) -> None:
    def shrink(task: ShrinkTask) -> Shrunk:
        if task.failure == failure(8):
            raise KeyboardInterrupt
        return Shrunk(script(40_000), task.failure, True, 7)

    players = Players(project, lambda number: failed(7 + number) if number < 2 else passed())
    players.shrink = shrink
    done = run(players)
    assert done.interrupted
    assert listener.log[2:] == ["found robot.py:7", "found robot.py:8"]
    assert [(each.entry.script.end_us, each.repeats) for each in done.findings] == [(40_000, True), (MATCH_US, True)]


def test_what_was_found_is_saved_when_matches_cannot_be_run_any_more(project: Path, run: Run) -> None:
    def match(number: int) -> MatchResult:
        if number == 40:
            raise PyfrcError("the cluster is gone")
        return failed(7) if number == 0 else passed()

    players = Players(project, match)
    with pytest.raises(PyfrcError, match="the cluster is gone"):
        run(players, runs=64)
    assert saved(project) == ["valueerror-robot-f.jsonl"]


def test_of_a_robot_that_does_not_repeat_scripts_are_made_short_with_fewer_runs(project: Path, run: Run) -> None:
    unrepeatable = MatchResult(failure(7), script(), unrepeatable=("TalonFX",))
    players = Players(project, lambda number: unrepeatable if number == 0 else passed())
    done = run(players)
    assert done.unrepeatable == ("TalonFX",)
    (task,) = players.shrinkings
    assert (task.most_runs, task.seconds) == (50, None)


def test_frequent_failures_are_avoided_by_the_next_batch(project: Path, run: Run) -> None:
    players = Players(project, lambda number: failed(7))
    run(players, runs=96)
    left_out = [each.schedule.left_out[-1][1] for each in players.matches]
    assert (len(left_out), len(players.shrinkings)) == (96, 1)
    assert set(left_out[:32]) == {frozenset()}
    assert frozenset({"mode=teleop"}) in left_out[32:]


# -- with a limit of time ----------------------------------------------------------------------------------------------


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A monotonic clock that goes on only by hand."""
    clock = SimpleNamespace(now=1000.0)
    clock.monotonic = lambda: clock.now
    for module in (campaigns, playing, first_starts):
        monkeypatch.setattr(module, "time", clock)
    return clock


def test_a_campaign_ends_when_its_time_is_over(project: Path, run: Run, clock: SimpleNamespace) -> None:
    def match(number: int) -> MatchResult:
        clock.now += 1.0
        return passed(number % 10)

    players = Players(project, match)
    done = run(players, runs=None, seconds=25.0)
    assert (done.progress.matches, clock.now) == (25, 1025.0)


def test_time_is_left_for_failures_that_wait_to_be_shrunk(project: Path, run: Run, clock: SimpleNamespace) -> None:
    def match(number: int) -> MatchResult:
        clock.now += 1.0
        return failed(number) if number < 3 else passed()

    players = Players(project, match)
    done = run(players, runs=None, seconds=20.0)
    assert len(done.findings) == 3
    # At the first, none waits besides; what is left is 20 - 1 s, and others may come.
    assert players.shrinkings[0].seconds == 9.5
    assert all(each.seconds is not None and 5.0 <= each.seconds <= 60.0 for each in players.shrinkings)


def test_doubtful_failures_are_shrunk_when_the_matches_are_over(project: Path, run: Run, listener: Listener) -> None:
    lights = FuzzFailure(WHILE_DISABLED, "robot.py:9", "f", "robot.py:9: set()")
    players = Players(project, lambda number: [MatchResult(lights, script()), failed(7), passed()][min(number, 2)])
    run(players)
    assert listener.log == ["seen robot.py:9", "seen robot.py:7", "found robot.py:7", "found robot.py:9"]
    assert isinstance(players.tasks[-1], ShrinkTask)
    assert players.tasks[-1].failure == lights


def test_a_match_of_the_usual_length_is_never_too_long(
    project: Path, run: Run, clock: SimpleNamespace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(match_plan, "_WHOLE", 0.5)  # half of the matches are longer than usual

    def match(number: int) -> MatchResult:
        clock.now += 5.0
        return passed(number % 10)

    players = Players(project, match)
    done = run(players, runs=None, seconds=400.0)
    assert done.progress.cost == 5.0 / 15.0
    lengths = {match_seconds(players.project, each.schedule) for each in players.matches}
    assert lengths == {5.0, 30.0}  # one as long as a real one would take an eighth of the time


def test_the_next_campaign_goes_on_where_this_one_ended(project: Path, run: Run) -> None:
    first = Players(project, lambda number: passed(number % 10))
    run(first, runs=32)
    second = Players(project, lambda number: passed(number % 10))
    done = run(second, runs=64, resume=True)
    again = done.progress.matches - 32
    assert 0 < again <= 24  # those that were worth continuing
    assert {each.schedule.seeds for each in second.matches[:again]} <= {each.schedule.seeds for each in first.matches}
    assert not {each.schedule.seeds[-1] for each in first.matches} & {
        each.schedule.seeds[-1] for each in second.matches[again:]
    }
    third = Players(project, lambda number: passed())
    assert run(third, runs=64).progress.matches == 64
