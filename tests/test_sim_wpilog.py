"""`pyfrc sim --wpilog`: the log has what the robot publishes, as the robot's own data log has it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject, RobotProject

from pyfrc_core.sim.engine.past_run import PastRun
from pyfrc_core.sim.logs import open_log

ROBOT = """
    import ntcore
    import wpilib
    from wpimath.geometry import Pose2d, Rotation2d

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            wpilib.DataLogManager.start()
            table = ntcore.NetworkTableInstance.getDefault().getTable("Lift")
            self.count = table.getIntegerTopic("count").publish()
            self.state = table.getStringTopic("state").publish()
            self.volts = table.getDoubleArrayTopic("volts").publish()
            self.pose = table.getStructTopic("pose", Pose2d).publish()
            self.turns = 0
            self.state.set("ready")

        def teleopPeriodic(self):
            self.turns += 1
            self.count.set(self.turns)
            self.state.set("up" if self.turns >= 25 else "ready")
            self.volts.set([self.turns / 4, 12.0])
            self.pose.set(Pose2d(self.turns / 50, 2.0, Rotation2d(0.5)))
"""
TEMPLATES = Path(__file__).parents[1] / "templates"
#: What WPILib 2027 publishes: when the process was started.
PROGRAM_START = "nt:/Robot/ProgramStartTime"
SIM = ("sim", "--ui", "none", "--mode", "teleop", "--seconds", "1", "--wpilog")


def logged(project: RobotProject, name: str) -> PastRun:
    result = project.run(*SIM, name)
    assert result.code == 0, result.output
    return open_log(project.path / name, 27.0).run


def changes(run: PastRun, *beginnings: str) -> dict[str, tuple[list[float], list[Any]]]:
    """The times and values of what the log has, by path."""
    found = {}
    for history in run.histories.values():
        for path in history.paths():
            if path.startswith(beginnings or "") and path != PROGRAM_START:
                times, values = history.changes(path)
                found[path] = list(times), list(values)
    return found


def test_the_log_has_what_the_robot_publishes_and_each_run_writes_the_same(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    run = logged(project, "a.wpilog")
    found = changes(run, "nt:/Lift")
    assert found["nt:/Lift/state"] == ([0.0, 0.5], ["ready", "up"])
    assert found["nt:/Lift/count"] == ([turn / 50 for turn in range(1, 51)], list(range(1, 51)))
    assert found["nt:/Lift/volts"][1][-1] == (12.5, 12.0)
    assert found["nt:/Lift/pose/translation/x"][1][-1] == 1.0
    assert found["nt:/Lift/pose/rotation/value"][1][-1] == 0.5
    types = {path: value for path, value in run.histories["network"].now.items() if path.startswith("type:/Lift")}
    assert types == {
        "type:/Lift/count": "int",
        "type:/Lift/state": "string",
        "type:/Lift/volts": "double[]",
        "type:/Lift/pose": "struct:Pose2d",
    }
    (own,) = (project.path / ".pyfrc" / "logs").glob("*.wpilog")
    assert changes(open_log(own, 27.0).run, "nt:/Lift") == found
    first = changes(run)
    assert len(first) > 100
    assert changes(logged(project, "b.wpilog")) == first


@pytest.mark.parametrize("fails", ["1 / 0", "os._exit(3)"])
def test_the_log_of_a_robot_that_fails_is_whole(fails: str, make_project: MakeProject) -> None:
    turn = f"self.turns += 1\n            if self.turns == 30:\n                import os\n                {fails}"
    project = make_project({"robot.py": ROBOT.replace("self.turns += 1", turn)})
    result = project.run(*SIM, "a.wpilog")
    assert result.code == 1, result.output
    opened = open_log(project.path / "a.wpilog", 27.0)
    assert opened.problem == ""
    assert opened.run.histories["network"].now["nt:/Lift/count"] == 29


TALKING = """
    import logging
    import sys

    import wpilib

    logging.basicConfig(format="%(levelname)s %(message)s")
    print("imported")

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.turns = 0

        def teleopPeriodic(self):
            self.turns += 1
            if self.turns == 10:
                print("over the", end=" ")
                print("line\\nat the switch: ä")
            if self.turns == 20:
                print("late", file=sys.stderr)
                logging.warning("hot")
            if self.turns == 30:
                wpilib.reportWarning("no target")
            if self.turns == 40:
                self.lift.set(1)
"""


def test_the_log_has_the_console(make_project: MakeProject) -> None:
    project = make_project({"robot.py": TALKING})
    result = project.run(*SIM, "a.wpilog")
    assert result.code == 1
    run = open_log(project.path / "a.wpilog", 27.0).run
    printed = [(round(each.time, 2), each.text) for each in run.happened]
    assert [(time, text) for time, text in printed if time < 0.8] == [
        (0.0, "imported"),
        (0.2, "over the line"),
        (0.2, "at the switch: ä"),
        (0.4, "late"),
        (0.4, "WARNING hot"),
        (0.6, "WARNING no target"),
    ]
    assert printed[-1] == (0.8, "AttributeError: 'MyRobot' object has no attribute 'lift'")
    assert all(text in result.output for time, text in printed if time < 0.8)  # the terminal has them, too


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="on Windows, no file is replaced while it is open")
def test_a_log_that_is_written_anew_does_not_change_what_others_have_opened(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOT})
    logged(project, "a.wpilog")
    before = (project.path / "a.wpilog").read_bytes()
    with (project.path / "a.wpilog").open("rb") as opened:
        logged(project, "a.wpilog")
        assert opened.read() == before


@pytest.mark.slow
@pytest.mark.season_2026
@pytest.mark.parametrize("template", ["magic", "swerve"])
def test_an_unchanged_template_does_what_its_log_has(template: str, make_project: MakeProject) -> None:
    project = make_project({})
    project.copy(TEMPLATES / template)
    drive = '{"format": "pyfrc-input 1", "end": 4.0}\n{"t": 0.5, "set": {"mode": "autonomous"}}\n'
    drive += '{"t": 2.0, "set": {"mode": "teleop", "joysticks[0].axes[1]": -0.6, "joysticks[0].buttons[1]": true}}\n'
    (project.path / "drive.jsonl").write_text(drive, encoding="utf-8")
    result = project.run("sim", "--ui", "none", "--script", "drive.jsonl", "--wpilog", "match.wpilog")
    assert result.code == 0, result.output
    said = project.run("sim", "--ui", "none", "--log", "match.wpilog").stdout
    assert "no difference: " in said
    assert "exactly the same" in said
