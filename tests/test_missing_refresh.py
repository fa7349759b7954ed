"""A plain `RobotBase` whose loop never calls `refreshData` stays disabled for good: its passing tests warn of it."""

from __future__ import annotations

import pytest
from conftest import MakeProject, RobotProject

ROBOT = """
    import wpilib


    class MyRobot(wpilib.RobotBase):
        def startCompetition(self):
            self.running = True
            motor = wpilib.PWMSparkMax(0)
            while self.running:
                {refresh}
                motor.set(0.5 if self.isEnabled() else 0)
                wpilib.wait(0.02)

        def endCompetition(self):
            self.running = False
"""
SENTENCE = "MyRobot still finds itself disabled while the driver station has enabled it"
READY_MADE = "from pyfrc.tests.basic import *\n"


@pytest.fixture
def forgetful(make_project: MakeProject) -> RobotProject:
    """A robot that never refreshes."""
    return make_project({"robot.py": ROBOT.format(refresh="pass"), "tests/test_ready_made.py": READY_MADE})


def test_the_ready_made_tests_warn(forgetful: RobotProject) -> None:
    """Once in the summary, with the line and the remedy."""
    result = forgetful.run("test", "--", "-k", "operator")
    assert result.code == 0, result.output
    place = forgetful.place("robot.py", "def startCompetition")
    assert f"UserWarning: {place}: {SENTENCE}" in result.stdout
    assert "Call that at the beginning of each turn" in result.stdout


def test_the_simulator_warns_once(forgetful: RobotProject) -> None:
    """After some seconds enabled."""
    result = forgetful.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "8")
    assert result.code == 0, result.output
    assert result.stdout.count(SENTENCE) == 1


@pytest.mark.slow
def test_robots_that_refresh_are_not_warned_of(make_project: MakeProject) -> None:
    """Neither in tests nor in the simulator."""
    refresh = "wpilib.DriverStation.refreshData()"
    project = make_project({"robot.py": ROBOT.format(refresh=refresh), "tests/test_ready_made.py": READY_MADE})
    assert "still finds itself disabled" not in project.run("test").output
    simulated = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "8")
    assert "still finds itself disabled" not in simulated.output
