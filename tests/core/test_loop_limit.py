"""Robots with a loop of their own: how long a turn may take, and whether they take in what the driver station sends."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from textwrap import dedent
from types import ModuleType
from typing import Any

import pytest
import wpilib

from pyfrc_core.config.settings import Settings
from pyfrc_core.project.robot_files import RobotFiles
from pyfrc_core.runtime.checks.loop_limit import LoopLimit, LoopWaitsError
from pyfrc_core.runtime.checks.refresh import RefreshCheck
from pyfrc_core.runtime.robot import RobotRun
from pyfrc_core.wpi import station

#: The library's loop: `magicbot` is recognized by its module's name.
MAGIC = """
class MagicRobot(RobotBase):
    control_loop_wait_time = 0.02

    def startCompetition(self):
        self.robotInit()
        while not self.ended:
            self.teleopPeriodic()
            wait(20)

    def endCompetition(self):
        self.ended = True

    def robotInit(self):
        pass

    ended = False
"""

Waits = list[float]


class Library:
    """Robots with a library's loop, whose `teleopPeriodic` waits."""

    def __init__(self, run: RobotRun, directory: Path) -> None:
        self.run = run
        self.directory = directory
        self.waits: Waits = []
        self.names: dict[str, Any] = {"RobotBase": wpilib.RobotBase, "wait": self.wait, "waits": self.waits}

    def wait(self, milliseconds: float) -> None:
        if milliseconds:
            self.run.threads.sleep_until(self.run.clock.now_us + round(milliseconds * 1000))

    def module(self, name: str, directory: Path, text: str) -> ModuleType:
        file = directory / f"{name.rpartition('.')[2]}.py"
        file.parent.mkdir(exist_ok=True)
        file.write_text(dedent(text).lstrip("\n"))
        module = ModuleType(name)
        vars(module).update(self.names)
        exec(compile(file.read_text(), str(file), "exec"), vars(module))
        return module

    def robot(self, text: str) -> type[Any]:
        self.names["MagicRobot"] = self.module("magicbot.robot", self.directory / "library", MAGIC).MagicRobot
        found: type[Any] = self.module("robot", self.directory / "project", text).Robot
        return found


@pytest.fixture
def library(run: RobotRun, tmp_path: Path) -> Library:
    return Library(run, tmp_path)


@pytest.fixture
def exceeded(run: RobotRun, tmp_path: Path) -> list[tuple[float, LoopWaitsError]]:
    """What is reported: a turn has 100 ms, in autonomous mode 300."""
    settings = Settings()
    settings = replace(
        settings, test=replace(settings.test, loop_seconds=0.1), match=replace(settings.match, autonomous=0.3)
    )
    found: list[tuple[float, LoopWaitsError]] = []
    LoopLimit(run, RobotFiles(tmp_path / "project"), settings, lambda error: found.append((run.clock.now, error)))
    return found


MAGIC_ROBOT = """
class Robot(MagicRobot):
    def robotInit(self):
        wait(400)

    def teleopPeriodic(self):
        self.drive()

    def drive(self):
        wait(waits.pop(0) if waits else 0)
"""

Exceeded = list[tuple[float, LoopWaitsError]]


def test_a_turn_of_a_librarys_loop_is_limited_and_robot_init_is_not(
    run: RobotRun, library: Library, exceeded: Exceeded
) -> None:
    run.construct(library.robot(MAGIC_ROBOT))
    run.start()
    station.set_mode(enabled=True)
    library.waits += [0, 0, 100, 0, 101, 0]
    run.run_until(1_000_000)
    # 0.40 .42 .44 (waits until .54) .56 .58: too long at .68
    assert [(round(at, 6), error.place, error.begins_at, error.function) for at, error in exceeded] == [
        (0.680001, "robot.py:9", "robot.py:8", "teleopPeriodic")
    ]
    assert run.alive


def test_turns_of_a_librarys_loop_that_take_longer_than_its_period_are_overruns(
    run: RobotRun, library: Library, exceeded: Exceeded
) -> None:
    robot = library.robot(MAGIC_ROBOT.replace("wait(400)", "self.control_loop_wait_time = 0.03"))
    run.construct(robot)
    run.start()
    library.waits += [30, 31, 0, 50, 10]
    run.run_until(60_000)
    assert run.overruns_until_now() == (0, 0)
    run.run_until(1_000_000)
    assert run.overruns_until_now() == (2, 50_000)
    assert exceeded == []


def test_a_turn_is_judged_by_the_mode_in_which_it_began(run: RobotRun, library: Library, exceeded: Exceeded) -> None:
    run.construct(library.robot(MAGIC_ROBOT.replace("wait(400)", "pass")))
    run.start()
    station.set_mode_named("autonomous")
    run.run_until(20_000)
    library.waits += [0, 300, 0, 0, 301]
    run.run_until(100_000)
    station.set_mode_named("teleop")
    run.run_until(390_000)
    assert exceeded == []
    station.set_mode_named("test")
    run.run_until(2_000_000)
    assert [error.note.partition(" s of")[0] for _, error in exceeded] == [
        "robot.py:9: teleopPeriodic has not returned after 0.3"
    ]


# -- what the driver station sends ------------------------------------------------------------------------------------


def own_loop(library: Library, refreshes: bool) -> type[Any]:
    def turn() -> None:
        if refreshes:
            wpilib.DriverStation.refreshData()
        library.wait(20)

    library.names["turn"] = turn
    return library.robot(
        """
        class Robot(RobotBase):
            def startCompetition(self):
                while True:
                    turn()

            def endCompetition(self): ...
        """
    )


def looks(run: RobotRun, check: RefreshCheck, seconds: float) -> list[tuple[float, str]]:
    """What a check reports, asked every 40 ms, and when."""
    found = []
    end_us = run.clock.now_us + round(seconds * 1e6)
    while run.clock.now_us < end_us:
        if (said := check.look()) is not None:
            found.append((run.clock.now, said))
        run.run_until(run.clock.now_us + 40_000)
    return found
