"""Watchdogs, motor safety and late loops of 2027, in robot time: as in 2026."""

from __future__ import annotations

import json

from conftest import MakeProject

TIMED = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.motor = wpilib_drivers.PWMSparkMax(0)
            self.motor.set_safety_enabled(True)
            self.dog = wpilib.Watchdog(0.1, self.barked)
            self.barks, self.began = [], wpilib.Timer.get_timestamp()

        def barked(self):
            self.barks.append(round(wpilib.Timer.get_timestamp() - self.began, 3))
            print("barked", self.barks[-1])

        def autonomous_init(self):
            self.motor.set_throttle(0.5)
            self.dog.reset()
            self.dog.add_epoch("one")

        def teleop_periodic(self):
            self.motor.set_throttle(0.25)
            wpilib.wait(0.03)
"""
TIMED_INPUTS = """{"format": "pyfrc-input 1", "end": 2.0}
{"t": 0.5, "set": {"mode": "autonomous"}}
{"t": 1.0, "set": {"mode": "teleop"}}
{"t": 1.5, "set": {"mode": "disabled"}}
"""

WITH_OPMODES = """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.OpModeRobot):
        def __init__(self):
            super().__init__()
            self.motor = wpilib_drivers.PWMSparkMax(0)
            self.motor.set_safety_enabled(True)


    @wpilib.teleop
    class Drive(wpilib.PeriodicOpMode):
        def __init__(self, robot):
            super().__init__()
            self.robot = robot
            self.n = 0

        def start(self):
            self.robot.motor.set_throttle(0.5)

        def periodic(self):
            self.n += 1
            if self.n > 20:
                wpilib.wait(0.03)
"""
OPMODE_INPUTS = """{"format": "pyfrc-input 1", "end": 2.0}
{"t": 0.5, "set": {"control.opmode": "Drive", "mode": "teleop"}}
{"t": 1.5, "set": {"mode": "disabled"}}
"""


def test_a_timed_robot(make_project: MakeProject) -> None:
    project = make_project({"robot.py": TIMED, "inputs.jsonl": TIMED_INPUTS})
    result = project.run("sim", "--ui", "none", "--script", "inputs.jsonl", "--record", "a.jsonl")
    assert result.code == 0, result.output
    assert "Watchdog not fed within 0.100000s, at 0.600 s" in result.output
    assert "barked 0.6\n" in result.output
    assert "PWM 0... Output not updated often enough" in result.output
    assert "Loop time of 0.020000s overrun: the turn that began at 1.000 s took 0.030 s" in result.output
    assert "TeleopPeriodic(): 0.030000s" in result.output
    assert "loop overruns: 17, the longest turn 0.030 s of robot time" in result.output
    trace = (project.path / "a.trace.jsonl").read_text("utf-8").splitlines()
    changes = [each for each in map(json.loads, trace) if "pwm[0].value" in each.get("set", {})]
    motor = [(each["t"], each["set"]["pwm[0].value"]) for each in changes]
    assert motor == [(0.02, 0.0), (0.5, 0.5), (0.62, 0.0), (1.0, 0.25)]  # stopped 0.1 s after it was last set


def test_a_robot_with_opmodes(make_project: MakeProject) -> None:
    project = make_project({"robot.py": WITH_OPMODES, "inputs.jsonl": OPMODE_INPUTS})
    result = project.run("sim", "--ui", "none", "--script", "inputs.jsonl")
    assert result.code == 0, result.output
    assert "PWM 0... Output not updated often enough" in result.output
    assert "loop overruns: 20, the longest turn 0.030 s of robot time" in result.output
