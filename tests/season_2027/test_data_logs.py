"""Data logs of 2027: those that robot code starts are complete, those of the simulator too; both are input scripts."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import MakeProject, RobotProject
from wpilog import DataLogReader

ROBOT = """
    import os

    import ntcore
    import wpilib
    import wpilib_drivers
    import wpilog

    {log}


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            wpilib.DataLogManager.start()
            wpilib.DriverStation.start_data_log(wpilib.DataLogManager.get_log())
            self.pad, self.timer = wpilib.Joystick(0), wpilib.Timer()
            self.motors = [wpilib_drivers.PWMSparkMax(channel) for channel in range(3)]
            self.count, self.turns = 0, wpilog.DoubleLogEntry(wpilib.DataLogManager.get_log(), "/turns")
            self.entry = ntcore.NetworkTableInstance.get_default().get_entry("/robot/turns")

        def robot_periodic(self):
            self.count += 1
            self.turns.append(self.count)
            self.entry.set_double(self.count)
            if self.count == 5:
                wpilib.DataLogManager.log("hello")
            {turn}

        def autonomous_periodic(self):
            self.motors[0].set_throttle(0.5 if wpilib.MatchState.get_game_data() == "LRL" else 0.1)

        def teleop_periodic(self):
            angle = wpilib.get_pov_angle(self.pad.get_pov())
            self.motors[0].set_throttle(self.pad.get_raw_axis(1))
            self.motors[1].set_throttle(angle.degrees() / 400 if angle else 0.7 if self.pad.get_raw_button(0) else 0)
            self.motors[2].set_throttle(0.3 if wpilib.MatchState.get_alliance() == wpilib.Alliance.BLUE else 0)
"""
DRIVEN = """{"format": "pyfrc-input 1", "end": 4.0}
{"t": 0, "set": {"alliance_station": "blue2", "event.game_specific_message": "LRL"}}
{"t": 0.5, "set": {"mode": "autonomous"}}
{"t": 1, "set": {"mode": "disabled"}}
{"t": 1.5, "set": {"mode": "teleop", "joysticks[0].axes[1]": -0.4, "joysticks[0].buttons[0]": true}}
{"t": 2, "set": {"joysticks[0].buttons[0]": false, "joysticks[0].povs[0]": 135}}
{"t": 3, "set": {"control.eStop": true}}
"""
ZERO = 10**15
"""HAL time at robot time 0, in nanoseconds: the log's times are the HAL's."""


def robot(turn: str = "pass", log: str = "") -> dict[str, str]:
    return {"robot.py": ROBOT.replace("{turn}", turn).replace("{log}", log), "drive.jsonl": DRIVEN}


def records(file: Path) -> dict[str, list[tuple[int, Any]]]:
    """What is in a log: time and value of each record, by entry."""
    reader = DataLogReader(str(file))
    assert reader.is_valid(), file
    names, found = {}, {}
    for record in reader:
        if record.is_start():
            start = record.get_start_data()
            names[start.entry] = (start.name, start.type)
            found.setdefault(start.name, [])
        elif not record.is_control():
            name, kind = names[record.get_entry()]
            value = {"double": record.get_double, "string": record.get_string}.get(kind, lambda: None)()
            found[name].append((record.get_timestamp(), value))
    return found


def log_of(project: RobotProject) -> Path:
    (log,) = (project.path / ".pyfrc" / "logs").glob("*.wpilog")
    return log


def outputs(trace: Path) -> list[tuple[float, str, Any]]:
    """The values of motors, by time."""
    changes = (change for change in map(json.loads, trace.read_text("utf-8").splitlines()) if "t" in change)
    return [(each["t"], path, value) for each in changes for path, value in each["set"].items() if path[:3] == "pwm"]


def test_the_log_of_a_headless_match(make_project: MakeProject) -> None:
    project = make_project(robot())
    result = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "20")
    assert re.search(r"data log: .pyfrc/logs/FRC_\d+_\d+.wpilog", result.output)
    log = records(log_of(project))
    assert [value for _, value in log["/turns"]] == list(range(1, 1001))
    last_ns = ZERO + 20_000_000_000
    assert log["/turns"][-1][0] == last_ns
    assert log["NT:/robot/turns"][-1] == (last_ns, 1000)
    assert [value for _, value in log["messages"]] == ["hello"]
    assert "DS:controlWord" in log


@pytest.mark.parametrize("end", ["1 / 0", "os._exit(3)", "exit()"])
def test_the_log_of_a_robot_that_fails(end: str, make_project: MakeProject) -> None:
    project = make_project(robot(f"{end} if self.count == 333 else None"))
    result = project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "20")
    assert result.code == 1, result.output
    assert [value for _, value in records(log_of(project))["/turns"]] == list(range(1, 334))


@pytest.mark.parametrize("isolation", [[], ["--no-isolation"]])
def test_each_test_has_a_log(isolation: list[str], make_project: MakeProject) -> None:
    test = """
        import pytest

        @pytest.mark.parametrize("seconds", [1, 2])
        def test_ends(control, seconds):
            with control.run_robot():
                control.step_timing(seconds=seconds, autonomous=False, enabled=True)
            assert seconds == 1
    """
    own = 'OWN = wpilog.DataLogWriter("own.wpilog")'
    project = make_project(robot(log=own) | {"tests/match_test.py": test})
    result = project.run("test", *isolation)
    assert "data logs: .pyfrc/logs/test\n" in result.stdout
    found = {file.name: len(records(file)["/turns"]) for file in (project.path / ".pyfrc/logs/test").iterdir()}
    assert found == {f"tests_match_test.py.test_ends[{seconds}].wpilog": seconds * 50 for seconds in (1, 2)}


def test_a_log_that_is_started_at_import(make_project: MakeProject) -> None:
    project = make_project(robot(log="wpilib.DataLogManager.start()"))
    assert project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "1").code == 0
    assert len(records(log_of(project))["/turns"]) == 50


def test_the_log_of_a_robot_replays_to_the_same_outputs(make_project: MakeProject) -> None:
    project = make_project(robot())
    result = project.run("sim", "--ui", "none", "--script", "drive.jsonl", "--record", "a.jsonl")
    assert result.code == 0, result.output
    log = log_of(project).rename(project.path / "match.wpilog")
    assert project.run("replay", log.name, "--trace", "replayed.jsonl").code == 0
    replayed = outputs(project.path / "replayed.jsonl")
    assert len(replayed) > 10
    assert replayed == outputs(project.path / "a.trace.jsonl")


@pytest.mark.parametrize("its_own", [True, False])
def test_a_log_has_the_opmodes(its_own: bool, make_project: MakeProject) -> None:
    project = make_project(
        {
            "robot.py": """
                import wpilib
                import wpilib_drivers


                class MyRobot(wpilib.OpModeRobot):
                    def __init__(self):
                        super().__init__()
                        wpilib.DataLogManager.start()
                        wpilib.DriverStation.start_data_log(wpilib.DataLogManager.get_log())
                        self.motor, self.stick = wpilib_drivers.PWMSparkMax(0), wpilib.Joystick(0)


                @wpilib.autonomous
                class Forward(wpilib.PeriodicOpMode):
                    def __init__(self, robot):
                        super().__init__()
                        self.motor = robot.motor

                    def periodic(self):
                        self.motor.set_throttle(0.4)

                    def end(self):
                        self.motor.set_throttle(0)


                @wpilib.teleop
                class Drive(wpilib.PeriodicOpMode):
                    def __init__(self, robot):
                        super().__init__()
                        self.robot = robot

                    def periodic(self):
                        self.robot.motor.set_throttle(self.robot.stick.get_raw_axis(1))
            """,
            "drive.jsonl": """{"format": "pyfrc-input 1", "end": 4.0}
{"t": 0.1, "set": {"control.opmode": "Forward", "mode": "disabled autonomous"}}
{"t": 1, "set": {"mode": "autonomous"}}
{"t": 2, "set": {"mode": "disabled"}}
{"t": 2.5, "set": {"control.opmode": "Drive", "mode": "teleop", "joysticks[0].axes[1]": -0.5}}
{"t": 3, "set": {"joysticks[0].axes[1]": -0.25}}
""",
        }
    )
    sim = ("sim", "--ui", "none", "--script", "drive.jsonl", "--record", "a.jsonl", "--wpilog", "own.wpilog")
    assert project.run(*sim).code == 0
    log = project.path / "own.wpilog" if its_own else log_of(project).rename(project.path / "match.wpilog")
    assert project.run("replay", log.name, "--trace", "replayed.jsonl").code == 0
    replayed = outputs(project.path / "replayed.jsonl")
    assert {value for _, path, value in replayed if path == "pwm[0].value"} >= {0.0, 0.4, -0.5}
    # A robot's log ends with what it logged last.
    assert replayed == outputs(project.path / "a.trace.jsonl")[: len(replayed)]


def test_the_simulators_own_log(make_project: MakeProject) -> None:
    project = make_project(robot())
    sim = ("sim", "--ui", "none", "--script", "drive.jsonl", "--record", "a.jsonl", "--wpilog", "own.wpilog")
    assert project.run(*sim).code == 0
    log = records(project.path / "own.wpilog")
    assert log["/hal_data/pwm[0].value"][1] == (ZERO + 500_000_000, 0.5)
    assert log["NT:/robot/turns"][-1] == (ZERO + 3_980_000_000, 199)
    assert project.run("replay", "own.wpilog", "--trace", "replayed.jsonl").code == 0
    assert outputs(project.path / "replayed.jsonl") == outputs(project.path / "a.trace.jsonl")


@pytest.mark.slow
def test_a_campaign_begins_with_a_log(make_project: MakeProject) -> None:
    project = make_project(robot())
    assert project.run("sim", "--ui", "none", "--script", "drive.jsonl").code == 0
    log = log_of(project).rename(project.path / "match.wpilog")
    result = project.run("fuzz", "--runs", "4", "--from", log.name, "-j", "1")
    assert result.code == 0, result.output
    assert list(project.path.rglob("*.wpilog")) == [log]  # matches have none


def test_a_log_without_a_driver_station_is_refused(make_project: MakeProject) -> None:
    project = make_project({"robot.py": robot()["robot.py"].replace("wpilib.DriverStation.start_data_log", "str")})
    assert project.run("sim", "--ui", "none", "--mode", "teleop", "--seconds", "1").code == 0
    result = project.run("replay", str(log_of(project)))
    assert result.code == 2
    assert "this data log has no data of a driver station" in result.output
    assert "wpilib.DriverStation.start_data_log(wpilib.DataLogManager.get_log()) logs it" in result.output
