"""The same robot and the same inputs give the same outputs in each season, at the same times: those of one table.

A season's WPILib differs by less than a step of a PWM signal. `season_2027/` has this test, too.
"""

from __future__ import annotations

import json
from typing import Any

import pytest
from conftest import MakeProject

from pyfrc_core.season import CURRENT

ROBOTS = {
    2026: """
    import wpilib
    import wpilib.drive


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.left, self.right = wpilib.PWMSparkMax(0), wpilib.PWMSparkMax(1)
            self.right.setInverted(True)
            self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
            self.roller = wpilib.PWMVictorSPX(2)
            self.stick = wpilib.Joystick(0)
            self.encoder = wpilib.Encoder(0, 1)
            self.encoder.setDistancePerPulse(0.01)
            self.distance = wpilib.AnalogInput(1)
            self.full = wpilib.DigitalInput(5)
            self.lamp = wpilib.DigitalOutput(6)
            self.claw = wpilib.Solenoid(wpilib.PneumaticsModuleType.CTREPCM, 3)
            self.timer = wpilib.Timer()
            self.beats = 0
            self.addPeriodic(self.beat, 0.05)

        def beat(self):
            self.beats += 1
            self.lamp.set(self.beats % 20 < 10)

        def autonomousInit(self):
            self.timer.restart()
            self.encoder.reset()

        def autonomousPeriodic(self):
            if self.encoder.getDistance() < 1.0 and self.timer.get() < 1.5:
                self.drive.arcadeDrive(0.6, 0.1)
            else:
                self.drive.stopMotor()

        def teleopPeriodic(self):
            self.drive.arcadeDrive(-self.stick.getY(), -self.stick.getX())
            far = self.distance.getVoltage() > 2.5
            self.roller.set(0.0 if self.full.get() or far else self.stick.getRawAxis(3))
            if self.stick.getRawButtonPressed(2):
                self.claw.set(not self.claw.get())

        def testPeriodic(self):
            self.roller.setVoltage(3.0)

        def disabledInit(self):
            self.drive.stopMotor()
            self.roller.set(0)
""",
    2027: """
    import wpilib
    import wpilib_drivers


    class MyRobot(wpilib.TimedRobot):
        def __init__(self):
            super().__init__()
            self.left, self.right = wpilib_drivers.PWMSparkMax(0), wpilib_drivers.PWMSparkMax(1)
            self.right.set_inverted(True)
            self.drive = wpilib.DifferentialDrive(self.left, self.right)
            self.roller = wpilib_drivers.PWMVictorSPX(2)
            self.stick = wpilib.Joystick(0)
            self.encoder = wpilib.Encoder(0, 1)
            self.encoder.set_distance_per_pulse(0.01)
            self.distance = wpilib.AnalogInput(1)
            self.full = wpilib.DigitalInput(5)
            self.lamp = wpilib.DigitalOutput(6)
            self.claw = wpilib.Solenoid(wpilib.CANPort.CAN_S0, wpilib.PneumaticsModuleType.CTRE_PCM, 3)
            self.timer = wpilib.Timer()
            self.beats = 0
            self.add_periodic(self.beat, 0.05)

        def beat(self):
            self.beats += 1
            self.lamp.set(self.beats % 20 < 10)

        def autonomous_init(self):
            self.timer.restart()
            self.encoder.reset()

        def autonomous_periodic(self):
            if self.encoder.get_distance() < 1.0 and self.timer.get() < 1.5:
                self.drive.arcade_drive(0.6, 0.1)
            else:
                self.drive.stop_motor()

        def teleop_periodic(self):
            self.drive.arcade_drive(-self.stick.get_y(), -self.stick.get_x())
            far = self.distance.get_voltage() > 2.5
            self.roller.set_throttle(0.0 if self.full.get() or far else self.stick.get_raw_axis(3))
            if self.stick.get_raw_button_pressed(2):
                self.claw.set(not self.claw.get())

        def utility_periodic(self):
            self.roller.set_voltage(3.0)

        def disabled_init(self):
            self.drive.stop_motor()
            self.roller.set_throttle(0)
""",
}

#: The driver station, the drivers, and the sensors.
INPUTS = """\
{"format": "pyfrc-input 1", "robot": "robot.py", "seed": 0, "end": 8.0}
{"t": 0.1, "set": {"dio[5].value": false, "analog_in[1].voltage": 1.0}}
{"t": 0.5, "set": {"mode": "autonomous"}}
{"t": 1.0, "set": {"encoder[0].count": 80}}
{"t": 1.3, "set": {"encoder[0].count": 130}}
{"t": 2.4, "set": {"mode": "disabled"}}
{"t": 2.5, "set": {"mode": "teleop", "joysticks[0].axes[1]": -0.5, "joysticks[0].axes[3]": 0.75}}
{"t": 2.8, "set": {"joysticks[0].axes[0]": 0.25, "joysticks[0].buttons[2]": true}}
{"t": 3.0, "set": {"joysticks[0].buttons[2]": false, "dio[5].value": true}}
{"t": 3.3, "set": {"joysticks[0].buttons[2]": true, "dio[5].value": false, "analog_in[1].voltage": 3.1}}
{"t": 3.6, "set": {"joysticks[0].buttons[2]": false, "analog_in[1].voltage": 2.0, "power.vin_voltage": 11.5}}
{"t": 4.0, "set": {"control.dsAttached": false}}
{"t": 4.5, "set": {"control.dsAttached": true}}
{"t": 5.0, "set": {"control.eStop": true}}
{"t": 5.5, "set": {"control.eStop": false}}
{"t": 6.0, "set": {"mode": "test"}}
{"t": 6.5, "set": {"mode": "disabled"}}
{"t": 7.0, "set": {"mode": "teleop", "joysticks[0].axes[1]": 1.0, "joysticks[0].axes[0]": 0.0}}
"""

#: The outputs that change, by the time at which they do.
OUTPUTS: dict[float, dict[str, Any]] = {
    0.02: {
        "user_program_state": "disabled",
        "pwm[0].value": 0.0,
        "pwm[1].value": 0.0,
        "pwm[2].value": 0.0,
        "dio[6].value": True,
        "pcm[0][3].value": False,
    },
    0.5: {"user_program_state": "autonomous", "pwm[0].value": 0.337, "pwm[1].value": -0.35, "dio[6].value": False},
    1.0: {"dio[6].value": True},
    1.3: {"pwm[0].value": 0.0, "pwm[1].value": 0.0},
    1.5: {"dio[6].value": False},
    2.0: {"dio[6].value": True},
    2.4: {"user_program_state": "disabled"},
    2.5: {
        "user_program_state": "teleop",
        "pwm[0].value": 0.24,
        "pwm[1].value": -0.24,
        "pwm[2].value": 0.75,
        "dio[6].value": False,
    },
    2.8: {"pwm[1].value": -0.15, "pcm[0][3].value": True},
    3.0: {"pwm[2].value": 0.0, "dio[6].value": True},
    3.3: {"pcm[0][3].value": False},
    3.5: {"dio[6].value": False},
    3.6: {"pwm[2].value": 0.75},
    4.0: {
        "user_program_state": "disabled",
        "pwm[0].value": 0.0,
        "pwm[1].value": 0.0,
        "pwm[2].value": 0.0,
        "dio[6].value": True,
    },
    4.5: {
        "user_program_state": "teleop",
        "pwm[0].value": 0.24,
        "pwm[1].value": -0.15,
        "pwm[2].value": 0.75,
        "dio[6].value": False,
    },
    5.0: {
        "user_program_state": "disabled",
        "pwm[0].value": 0.0,
        "pwm[1].value": 0.0,
        "pwm[2].value": 0.0,
        "dio[6].value": True,
    },
    5.5: {"dio[6].value": False},
    6.0: {"user_program_state": "test", "pwm[2].value": 0.261, "dio[6].value": True},
    6.5: {"user_program_state": "disabled", "pwm[2].value": 0.0, "dio[6].value": False},
    7.0: {
        "user_program_state": "teleop",
        "pwm[0].value": -1.0,
        "pwm[1].value": 1.0,
        "pwm[2].value": 0.75,
        "dio[6].value": True,
    },
    7.5: {"dio[6].value": False},
}
#: The roboRIO's signals have steps of 1 microsecond, of 0.5 ms to full power.
STEP = 0.002


def test_outputs(make_project: MakeProject) -> None:
    project = make_project({"robot.py": ROBOTS[CURRENT.year], "inputs.jsonl": INPUTS})
    result = project.run("replay", "inputs.jsonl", "--trace", "trace.jsonl")
    assert result.code == 0, result.output
    expected, found = {}, {}
    state = dict.fromkeys(OUTPUTS[0.02])
    for line in (project.path / "trace.jsonl").read_text("utf-8").splitlines():
        step = json.loads(line)
        now = {path: value for path, value in step.get("set", {}).items() if path in state}
        changed = {path: value for path, value in now.items() if not is_the_same(value, state[path])}
        state |= changed
        if changed:
            found[step["t"]] = changed
    expected = {at: {path: approximate(value) for path, value in changed.items()} for at, changed in OUTPUTS.items()}
    assert found == expected


def is_the_same(value: Any, before: Any) -> bool:
    """Return whether a value is the one before, but for rounding."""
    return value == (approximate(before) if isinstance(value, float) and before is not None else before)


def approximate(value: Any) -> Any:
    """Return what a power of a motor, which is rounded, is compared with."""
    return pytest.approx(value, abs=STEP) if isinstance(value, float) else value
