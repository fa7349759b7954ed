"""WPILib data logs as input scripts: a robot does the same with them as it did when the log was written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROBOT = """
    import ntcore
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            {log}
            self.pad = wpilib.Joystick(0)
            self.motors = [wpilib.PWMSparkMax(channel) for channel in range(4)]
            self.timer = wpilib.Timer()
            self.chooser = wpilib.SendableChooser()
            self.chooser.setDefaultOption("Stay", 0.0)
            self.chooser.addOption("Go", 0.7)
            wpilib.SmartDashboard.putData("Auto", self.chooser)

        def autonomousInit(self):
            self.timer.restart()

        def autonomousPeriodic(self):
            self.motors[0].set(self.chooser.getSelected() if self.timer.get() < 1.0 else 0.1)

        def teleopPeriodic(self):
            seen = ntcore.NetworkTableInstance.getDefault().getTable("limelight")
            tag, pose = seen.getEntry("tid").getInteger(0), seen.getEntry("botpose").getDoubleArray([0.0])
            self.motors[0].set(self.pad.getRawAxis(1) + tag / 100 + sum(pose) / 10)
            self.motors[1].set(0.5 if self.pad.getRawButton(3) else self.pad.getPOV() / 400)
            self.motors[2].set(wpilib.DriverStation.getMatchTime() / 200)
            self.motors[3].set(len(wpilib.DriverStation.getGameSpecificMessage()) / 10 + self.alliance())

        def alliance(self):
            return 0.5 if wpilib.DriverStation.getAlliance() == wpilib.DriverStation.Alliance.kBlue else 0.0
"""
LOGGING = """wpilib.DataLogManager.start()
            wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())"""
SETTINGS = "[tool.pyfrc.match]\nautonomous = 2.0\nteleop = 3.0\n"

DRIVEN = """{"format": "pyfrc-input 1", "end": 6.0}
{"t": 0, "set": {"alliance_station": "blue2", "event.game_specific_message": "LRL"}}
{"t": 0.5, "set": {"nt:/SmartDashboard/Auto/selected": "Go", "nt:/limelight/tx": 3.5}}
{"t": 0.6, "set": {"nt:int:/limelight/tid": 7, "nt:double[]:/limelight/botpose": [1.0, 2.0]}}
{"t": 1, "set": {"mode": "autonomous", "match_time": 2}}
{"t": 3, "set": {"mode": "disabled", "match_time": 0}}
{"t": 3.5, "set": {"mode": "teleop", "match_time": 2.0, "joysticks[0].axes[1]": -0.4}}
{"t": 3.8, "set": {"joysticks[0].buttons[3]": true}}
{"t": 4, "set": {"joysticks[0].buttons[3]": false, "joysticks[0].povs[0]": 90}}
{"t": 4.5, "set": {"joysticks[0].plugged": false}}
{"t": 4.8, "set": {"joysticks[0].plugged": true, "joysticks[0].axes[1]": 0.3}}
{"t": 5.5, "set": {"control.eStop": true}}
"""


def robot(log: str = LOGGING) -> dict[str, str]:
    return {"robot.py": ROBOT.replace("{log}", log), "pyproject.toml": SETTINGS, "drive.jsonl": DRIVEN}


def changes(trace: Path) -> list[dict[str, Any]]:
    return [change for change in map(json.loads, trace.read_text(encoding="utf-8").splitlines()) if "t" in change]


def outputs(trace: Path) -> list[tuple[float, str, Any]]:
    """The values of motors, by time."""
    return [
        (change["t"], path, value)
        for change in changes(trace)
        for path, value in change["set"].items()
        if path.startswith("pwm[")
    ]


SIM = ("sim", "--ui", "none", "--script", "drive.jsonl", "--record", "recorded.jsonl")


def test_the_log_of_a_robot_replays_to_the_same_outputs(make_project) -> None:
    project = make_project(robot())
    result = project.run(*SIM)
    assert result.code == 0, result.output
    (log,) = (project.path / ".pyfrc" / "logs").glob("*.wpilog")
    log = log.rename(project.path / "match.wpilog")
    result = project.run("replay", "match.wpilog", "--trace", "replayed.jsonl")
    assert result.code == 0, result.output
    replayed = outputs(project.path / "replayed.jsonl")
    assert len(replayed) > 30
    assert replayed == outputs(project.path / "recorded.trace.jsonl")


def test_the_log_of_the_simulator_replays_to_the_same_outputs(make_project) -> None:
    project = make_project(robot("pass"))
    assert project.run(*SIM, "--wpilog", "match.wpilog").code == 0
    result = project.run("replay", "match.wpilog", "--trace", "replayed.jsonl")
    assert result.code == 0, result.output
    assert outputs(project.path / "replayed.jsonl") == outputs(project.path / "recorded.trace.jsonl")
