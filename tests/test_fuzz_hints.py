"""Hints at the end of a campaign: what grows, commands that are never finished, and loops that compute for long."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any

import pytest
from conftest import sampled
from spelling import spelled

from pyfrc_core.fuzz.match.work import MatchResult
from pyfrc_core.fuzz.oracle.growth import NETWORK_TABLES, Growth, Growths
from pyfrc_core.fuzz.oracle.hints import CampaignHints, LoopTimes, MatchHints
from pyfrc_core.processes.fork import FORK_IS_SAFE
from pyfrc_core.runtime.scripts.script import InputScript
from pyfrc_core.runtime.time.timed_loop import Periodic

ROBOT = """
    import commands2
    import wpilib

    class Lift(commands2.Subsystem):
        height = 0.0

    class Climb(commands2.Command):
        def __init__(self, lift):
            super().__init__()
            self.lift = lift

        def isFinished(self):  # it never is
            return self.lift.height > 5

    class Wait(Climb):
        def isFinished(self):
            return False

    class Up(Climb):
        def isFinished(self):
            return self.lift.height < 5

    class Hold(Climb):
        def isFinished(self):
            return self.lift.height > 6

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.history, self.lift = [], Lift()
            hold = Hold(self.lift)
            hold.addRequirements(self.lift)
            self.lift.setDefaultCommand(hold)

        def robotPeriodic(self):
            commands2.CommandScheduler.getInstance().run()
            self.history.append(0.0)

        def teleopInit(self):
            for kind in (Climb, Wait, Up):
                kind(self.lift).schedule()
    """


@pytest.mark.slow
def test_a_campaign_ends_with_hints(make_project: Any) -> None:
    project = make_project({"robot.py": ROBOT})
    fuzzed = project.run("fuzz", "--seed", "3", "--runs", "12")
    assert fuzzed.code == 0, fuzzed.output
    hints = [line for line in fuzzed.output.splitlines() if line.startswith("hint: ")]
    assert len(hints) == 2, fuzzed.output
    assert hints[0].startswith("hint: robot.history only grows: by about 50 elements a second, to 1")
    line = project.place("robot.py", "it never is")
    assert hints[1].startswith(
        f"hint: {line}: {spelled('Climb.isFinished')}() was never true: the command ran for up to "
    )


@pytest.mark.parametrize("isolation", sampled(["fork", "reuse"], "fork" if FORK_IS_SAFE else "reuse"))
def test_a_thread_that_does_not_end_with_the_robot_program(isolation: str, make_project: Any) -> None:
    robot = """
        import threading
        import time
        import wpilib

        class MyRobot(wpilib.TimedRobot):
            def robotInit(self):
                threading.Thread(target=self.look, name="camera").start()

            def look(self):
                while True:
                    time.sleep(0.5)  # for ever
        """
    project = make_project({"robot.py": robot, "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 2\n"})
    fuzzed = project.run("fuzz", "--runs", "5", "--isolation", isolation)
    assert fuzzed.code == 0, fuzzed.output
    (hint,) = [line for line in fuzzed.output.splitlines() if line.startswith("hint: ")]
    line = project.place("robot.py", "for ever")
    assert hint.startswith(f"hint: {line}: the thread 'camera' does not end with the robot program (5 matches)")


def test_threads_without_names_of_their_own_are_one_hint_a_line() -> None:
    campaign = CampaignHints()
    for number in range(2, 7):
        each = f"Thread-{number} (measure)"
        campaign.add(MatchHints(threads=(("robot.py:9", each), ("robot.py:9", f"Thread-{number + 1} (measure)"))))
    assert list(campaign.texts()) == [
        "robot.py:9: the thread 'Thread (measure)' does not end with the robot program (5 matches): "
        "end it in endCompetition, or make it a daemon"
    ]


def growths_of(sizes: list[int]) -> list[Growth]:
    attributes: dict[str, object] = {"log": []}
    growths = Growths(lambda: {"arm.log": (attributes, "log")})
    for second, size in enumerate(sizes):
        attributes["log"] = [0] * size
        growths.after_packet((second + 1) * 2_000_000)
    return list(growths.found())


def test_what_only_grows() -> None:
    assert growths_of([0, 20, 40, 60, 80, 100, 120, 140, 160]) == [Growth("arm.log", 10.0, 160)]
    # Since it was emptied, and while some input is there.
    assert growths_of([7, 7, 0, 0, 40, 60, 60, 80, 100, 120, 140, 160, 180, 180]) == [Growth("arm.log", 180 / 22, 180)]


@pytest.mark.parametrize(
    "sizes",
    [
        [0, 20, 40, 60, 80, 100, 120, 140],
        [0, 20, 40, 60, 80, 70, 100, 120, 140, 160],
        [0, 20, 40, 60, 80, 100, 120, 140, 160, 160, 160],
        [5] * 12,
    ],
    ids=["for a short time", "emptied again", "full", "as large as before"],
)
def test_what_does_not(sizes: list[int]) -> None:
    assert growths_of(sizes) == []


def test_the_time_of_loops_is_what_all_but_five_need() -> None:
    def compute() -> None:
        began = time.thread_time()
        while time.thread_time() - began < 0.002:
            pass

    loop = Periodic(compute, 0, 1_000, 0)
    times = LoopTimes(SimpleNamespace(timed_loop=SimpleNamespace(main=loop)))  # type: ignore[arg-type]
    for _ in range(5):
        loop.call()
    assert times.seconds == 0
    loop.call()
    assert times.seconds >= 0.002


def test_loops_that_compute_for_long_in_five_matches() -> None:
    campaign = CampaignHints()
    for seconds in (0.03, 0.05, 0.04, 0.01, 0.07):
        campaign.add(MatchHints(loop_seconds=seconds))
    assert not list(campaign.texts())
    campaign.add(MatchHints(loop_seconds=0.06))
    (text,) = campaign.texts()
    assert "need 50 ms of processor time or more on this computer, and a period is 20 ms (5 matches)" in text


def test_a_command_that_was_finished_once_is_no_hint() -> None:
    campaign = CampaignHints()
    for _ in range(5):
        campaign.add(MatchHints(unfinished={"robot.py:3: Climb.isFinished()": 9_000_000}))
    (text,) = campaign.texts()
    assert text == "robot.py:3: Climb.isFinished() was never true: the command ran for up to 9 s (5 matches)"
    campaign.add(MatchHints(finished=frozenset({"robot.py:3: Climb.isFinished()"})))
    assert not list(campaign.texts())


def test_a_match_has_the_hints_of_all_its_starts() -> None:
    script = InputScript((), 1)
    lift, climb = "robot.py:3: Lift.isFinished()", "robot.py:9: Climb.isFinished()"
    threads = (("robot.py:9", "camera"),)
    first = MatchHints((Growth("log", 5, 60), Growth("arm.log", 1, 20)), {lift: 9, climb: 7}, frozenset({climb}), 0.03)
    last = MatchHints((Growth("log", 9, 90),), {lift: 8}, frozenset({lift}), 0.01, threads=threads)
    played = MatchResult(None, script, hints=last).with_parts_before(MatchResult(None, script, hints=first))
    assert played.hints == MatchHints(
        (Growth("log", 9, 90), Growth("arm.log", 1, 20)),
        {lift: 9, climb: 7},
        frozenset({lift, climb}),
        0.03,
        threads=threads,
    )


def test_what_is_said_of_growth_of_outputs_and_of_starts() -> None:
    campaign = CampaignHints()
    for number, size in enumerate((9, 8, 7, 6)):
        campaign.add(MatchHints(growths=(Growth("arm.log", size, size * 10), Growth(NETWORK_TABLES, 2, number))))
    campaign.add(MatchHints(growths=(Growth("arm.log", 5, 50),)))
    campaign.always_set = ["robot.py:5"]
    campaign.unsteady = {"cause": "robot.py:7: TimeoutError"}
    campaign.failed_starts["cause"] = 2
    unsteady, always, grows = campaign.texts()
    assert unsteady == "robot.py:7: TimeoutError (at 2 of 5 starts, and not again with the same inputs)"
    assert always.startswith("robot.py:5: this sets an output in each loop while the robot is disabled")
    assert grows == ("robot.arm.log only grows: by about 7 elements a second, to 70 at the end of a match (5 matches)")
    campaign.add(MatchHints(growths=(Growth(NETWORK_TABLES, 3, 30),)))
    assert list(campaign.texts())[2].startswith("NetworkTables only grow: by about 2 elements a second, to ")
