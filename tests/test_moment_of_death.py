"""A robot's process that is killed, or ends itself: the moment and the mode in which it did are named."""

from __future__ import annotations

import pytest
from conftest import MakeProject, sampled

ROBOT = """
    import os
    import signal

    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def teleopPeriodic(self):
            if wpilib.Timer.getFPGATimestamp() > 1.5:
                DEATH
"""
DEATHS = {
    "killed": ("os.kill(os.getpid(), signal.SIGKILL)", "ended by signal 9 (SIGKILL)"),
    "exit": ("os._exit(3)", "ended itself with exit code 3"),
}
MOMENT = "at 1.52 s in teleop mode"

TEST = """
    def test_drive(control, robot):
        control.set_operator_control(enabled=True)
        control.run_test(lambda now: now < 5)
"""


def robot(death: str) -> str:
    return ROBOT.replace("DEATH", DEATHS[death][0])


@pytest.mark.parametrize(("death", "isolation"), sampled([("killed", "fork"), ("exit", "reuse")], ("exit", "reuse")))
def test_in_a_test(make_project: MakeProject, death: str, isolation: str) -> None:
    """In forked processes and in new ones."""
    project = make_project({"robot.py": robot(death), "tests/test_it.py": TEST})
    result = project.run("test", "--isolation", isolation)
    assert result.code == 1, result.output
    assert DEATHS[death][1] in result.blocks()["test_drive"]
    assert MOMENT in result.blocks()["test_drive"]


@pytest.mark.parametrize("death", sampled(DEATHS, "killed"))
def test_in_a_simulation(make_project: MakeProject, death: str) -> None:
    """As fast as it goes, updates come after dozens of packets."""
    project = make_project({"robot.py": robot(death)})
    result = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "5")
    assert result.code == 1, result.output
    assert "simulated 1.52 s" in result.output
    assert "failed at 1.52 s" in result.output
    assert DEATHS[death][1] in result.output
    assert MOMENT in result.output


@pytest.mark.slow
def test_in_a_campaign(make_project: MakeProject) -> None:
    """And in the replay of what it keeps."""
    settings = "[tool.pyfrc.fuzz]\nmatch_seconds = 5\n"
    project = make_project({"robot.py": robot("killed"), "pyproject.toml": settings})
    result = project.run("fuzz", "--runs", "1", "-j", "1")
    assert result.code == 1, result.output
    (script,) = (project.path / "tests/fuzz").glob("process_ended*.jsonl")
    replayed = project.run("replay", script)
    assert replayed.code == 1, replayed.output
    assert DEATHS["killed"][1] in replayed.output
    assert MOMENT in replayed.output
