"""What guides a campaign besides lines: states of the robot's program, branches and comparisons."""

from __future__ import annotations

import json
import subprocess
import sys
import textwrap
from typing import Any

import pytest

from pyfrc_core.compat import line_probes
from pyfrc_core.fuzz.goals import BRANCH, LINE, NEAR, STATE, kind_of
from pyfrc_core.fuzz.nearness import Nearness
from pyfrc_core.fuzz.seed_schedule import SeedSchedule, SeedScheduler

ROBOT = """
    import enum
    import commands2
    import magicbot
    import wpilib

    class Height(enum.Enum):
        LOW = 0
        HIGH = 1

    class Elevator:
        def __init__(self):
            self.height = Height.LOW
            self.speed = 0.25
            self.name = "elevator"

    class Shooter(magicbot.StateMachine):
        @magicbot.state(first=True, must_finish=True)
        def load(self, state_tm):
            if state_tm > 0.1:
                self.next_state("fire")

        @magicbot.state(must_finish=True)
        def fire(self):
            pass

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.elevator = Elevator()
            self.count = 0
            self.action = self.wait
            self.shooter = Shooter()
            self.shooter.logger = wpilib
            magicbot.magic_tunable.setup_tunables(self.shooter, "shooter")
            self.aim = commands2.RunCommand(lambda: None)
            self.aim.setName("Aim")

        def wait(self):
            pass

        def act(self):
            pass

        def teleopPeriodic(self):
            self.count += 1
            self.elevator.speed += 0.001
            self.shooter.engage()
            self.shooter.execute()
            commands2.CommandScheduler.getInstance().run()
            if self.count == 50:
                self.elevator.height = Height.HIGH
                self.action = self.act
                self.aim.schedule()
            if self.count == 1000000:
                self.never = 1
    """

GOALS = """
    import json
    from pyfrc_core.fuzz.match import FuzzTask
    from pyfrc_core.fuzz.match_executor import open_match_executor
    from pyfrc_core.fuzz.seed_schedule import SeedSchedule
    from pyfrc_core.project import find_project

    found, known = [], frozenset()
    with open_match_executor(find_project(), 1) as executor:
        for number in range(3):
            (played,) = executor.play([FuzzTask(SeedSchedule(((0, "a"),)), known, known)])
            found.append([played.failure and played.failure.text, sorted(map(repr, played.reached))])
            known = known.union(played.reached)
    print(json.dumps(found))
    """


def goals_of(project: Any) -> list[tuple[str | None, list[str]]]:
    program = textwrap.dedent(GOALS)
    done = subprocess.run([sys.executable, "-c", program], cwd=project.path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found: list[tuple[str | None, list[str]]] = json.loads(done.stdout.splitlines()[-1])
    return found


def test_states_branches_and_comparisons_are_goals(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 8.0\n"})
    (failure, first), (_, second), (_, third) = goals_of(project)
    assert failure is None
    for goal in (
        (STATE, "elevator.height", "LOW"),
        (STATE, "elevator.height", "LOW", "HIGH"),
        (STATE, "action", "MyRobot.act"),
        (STATE, "action", "MyRobot.act", "elevator.height", "HIGH"),
        (STATE, "shooter._StateMachine__state", "load", "fire"),
        (STATE, "commands", "Aim"),
        (STATE, "count", "16"),
    ):
        assert repr(goal) in first
    assert not [goal for goal in first if "speed" in goal or " at 0x" in goal]
    if line_probes.SUPPORTED:
        # The comparison with a million has one result in the first match: the second one measures how near it is.
        assert [goal for goal in first if "'branch'" in goal]
        assert len(second) == 1
        assert second[0].startswith("('near', 'robot.py', ")
    # The third match is the same as the second, and reaches nothing new.
    assert third == []


def test_a_comparison_that_comes_nearer_is_a_goal() -> None:
    measured = Nearness()
    goal = (NEAR, "robot.py", 3, 12)
    known = frozenset({(BRANCH, "robot.py", 3, 12, 0)})
    comparison = measured.comparison(goal)
    measured.begin(frozenset(), lambda: 5)
    for pair in (("a", "b"), (True, False), (float("nan"), 1.0), (10**400, 1.5)):
        comparison[pair]
    assert measured.reached(known) == {}
    levels = []
    for left in (100.0, 40.0, 41.0, 7.5):
        comparison[left, 0]
        (reached,) = measured.reached(known)
        levels.append(reached[-1])
    assert levels[0] < levels[1] == levels[2] < levels[3]

    measured.begin(known | frozenset({(*goal, levels[3]), (*goal, levels[0])}), lambda: 5)
    comparison[7.5, 0]
    assert measured.reached(known) == {}
    comparison[0.5, 0]
    assert list(measured.reached(known).values()) == [5]
    assert measured.reached(frozenset()) == {}
    assert measured.reached(known | {(BRANCH, "robot.py", 3, 12, 1)}) == {}


@pytest.mark.parametrize("difference", range(1, 16))
def test_counts_come_nearer_one_by_one(difference: int) -> None:
    measured = Nearness()
    goal = (NEAR, "robot.py", 3, 12)
    known = frozenset({(BRANCH, "robot.py", 3, 12, 0)})
    measured.comparison(goal)
    measured.begin(frozenset(), lambda: 0)
    measured.comparison(goal)[difference + 1, 0]
    known |= frozenset(measured.reached(known))
    measured.begin(known, lambda: 0)
    measured.comparison(goal)[difference, 0]
    assert measured.reached(known)


def test_matches_with_every_kind_of_goal_are_continued() -> None:
    scheduler = SeedScheduler(1)
    goals = {LINE: ("robot.py", 3), BRANCH: (BRANCH, "robot.py", 3, 4, 1), STATE: (STATE, "a", "1"), NEAR: (NEAR, 1, 2)}
    for number, (kind, goal) in enumerate(goals.items()):
        assert kind_of(goal) == kind
        scheduler.learn(SeedSchedule(((0, f"fuzz 1 {number}"),)), {goal: 1_000_000})
    bases = {scheduler.schedule(number).seeds[0][1] for number in range(100, 200)}
    assert {f"fuzz 1 {number}" for number in range(4)} <= bases
