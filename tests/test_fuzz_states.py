"""What guides a campaign besides lines: states of the robot's program and branches."""

from __future__ import annotations

import json
import subprocess
import sys
import textwrap
from typing import Any

from conftest import _start_python

from pyfrc_core.fuzz.guidance.goals import BRANCH, LINE, STATE, kind_of
from pyfrc_core.fuzz.guidance.seed_schedule import SeedSchedule, SeedScheduler

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
    """

GOALS = """
    import json
    from pyfrc_core.fuzz.match.work import FuzzTask
    from pyfrc_core.fuzz.campaign.executors import open_match_executor
    from pyfrc_core.fuzz.guidance.seed_schedule import SeedSchedule
    from pyfrc_core.project import find_project

    found, known = [], frozenset()
    with open_match_executor(find_project(), 1) as executor:
        for number in range(2):
            (played,) = executor.play([FuzzTask(SeedSchedule(((0, "a"),)), known)])
            found.append([played.failure and played.failure.text, sorted(map(repr, played.reached))])
            known = known.union(played.reached)
    print(json.dumps(found))
    """


def goals_of(project: Any) -> list[tuple[str | None, list[str]]]:
    program = textwrap.dedent(GOALS)
    done = _start_python([sys.executable, "-c", program], cwd=project.path, stdout=subprocess.PIPE)
    with done.stdout:
        *_, last = done.stdout
    assert done.wait() == 0
    found: list[tuple[str | None, list[str]]] = json.loads(last)
    return found


def test_states_and_branches_are_goals(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "pyproject.toml": "[tool.pyfrc.fuzz]\nmatch_seconds = 8.0\n"})
    (failure, first), (_, second) = goals_of(project)
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
    assert bool([goal for goal in first if "'branch'" in goal]) == (sys.version_info >= (3, 12))
    # The second match is the same as the first, and reaches nothing new.
    assert second == []


def test_matches_with_every_kind_of_goal_are_continued() -> None:
    scheduler = SeedScheduler(1)
    goals = {LINE: ("robot.py", 3), BRANCH: (BRANCH, "robot.py", 3, 4, 1), STATE: (STATE, "a", "1")}
    for number, (kind, goal) in enumerate(goals.items()):
        assert kind_of(goal) == kind
        scheduler.learn(SeedSchedule(((0, f"fuzz 1 {number}"),)), {goal: 1_000_000})
    bases = {scheduler.schedule(number).seeds[0][1] for number in range(100, 200)}
    assert {f"fuzz 1 {number}" for number in range(3)} <= bases
