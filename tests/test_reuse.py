"""Robots whose interpreters come out as good as new: each test in one that has run others before is as in a fork."""

from __future__ import annotations

import re
import sys

import pytest
from conftest import MakeProject, RobotProject, sampled

pytestmark = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="nothing is forked here to compare with")

COMMANDS = """
    import commands2
    import wpilib
    from commands2.button import CommandXboxController


    class Arm(commands2.Subsystem):
        def __init__(self):
            super().__init__()
            self.motor = wpilib.PWMSparkMax(1)

        def periodic(self):
            wpilib.SmartDashboard.putNumber("arm", self.motor.get())


    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.arm = Arm()
            self.pad = CommandXboxController(0)
            self.pad.a().whileTrue(self.arm.run(lambda: self.arm.motor.set(0.5)))
            self.arm.setDefaultCommand(self.arm.run(lambda: self.arm.motor.set(self.pad.getLeftY())))
            self.chooser = wpilib.SendableChooser()
            self.chooser.setDefaultOption("up", self.arm.run(lambda: self.arm.motor.set(1.0)))
            wpilib.SmartDashboard.putData("auto", self.chooser)
            wpilib.SmartDashboard.putData("scheduler", commands2.CommandScheduler.getInstance())
            wpilib.Preferences.initDouble("speed", 0.3)

        def autonomousInit(self):
            self.auto = self.chooser.getSelected()
            self.auto.schedule()
"""

MAGIC = """
    import magicbot
    import wpilib
    from magicbot import StateMachine, state, tunable, will_reset_to


    class Shooter(StateMachine):
        motor: wpilib.PWMSparkMax
        speed = tunable(0.5)
        wanted = will_reset_to(False)

        @state(first=True)
        def spin(self):
            self.motor.set(self.speed)


    class MyRobot(magicbot.MagicRobot):
        shooter: Shooter

        def createObjects(self):
            self.motor = wpilib.PWMSparkMax(2)

        def teleopPeriodic(self):
            self.shooter.engage()
"""

DEVICES = """
    import threading
    import time
    import wpilib


    class Constants:
        MOTOR = None


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            Constants.MOTOR = wpilib.PWMSparkMax(5)
            self.ball = wpilib.Ultrasonic(1, 2)
            self.claw = wpilib.DoubleSolenoid(wpilib.PneumaticsModuleType.CTREPCM, 0, 1)
            self.light = wpilib.Solenoid(wpilib.PneumaticsModuleType.REVPH, 3)
            self.pdp = wpilib.PowerDistribution()
            self.encoder = wpilib.Encoder(3, 4)
            self.counter = wpilib.Counter(6)
            self.gyro = wpilib.ADXRS450_Gyro()
            self.accelerometer = wpilib.BuiltInAccelerometer()
            self.field = wpilib.Field2d()
            wpilib.SmartDashboard.putData("field", self.field)
            wpilib.SmartDashboard.putData("pdp", self.pdp)
            wpilib.DataLogManager.start()
            self.watch = wpilib.Notifier(self.look)
            self.watch.startPeriodic(0.1)
            threading.Thread(target=self.wait, daemon=True).start()

        def look(self):
            wpilib.SmartDashboard.putNumber("distance", self.ball.getRangeInches())

        def wait(self):
            while True:
                time.sleep(0.5)
                self.light.toggle()

        def teleopPeriodic(self):
            Constants.MOTOR.set(0.3)
            self.claw.set(wpilib.DoubleSolenoid.Value.kForward)
"""

REV = """
    import rev
    import wpilib


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.motor = rev.SparkMax(1, rev.SparkMax.MotorType.kBrushless)
            self.encoder = self.motor.getEncoder()

        def teleopPeriodic(self):
            self.motor.set(0.4)
            wpilib.SmartDashboard.putNumber("speed", self.encoder.getVelocity())
"""

PATHS = """
    import commands2
    from pathplannerlib.auto import NamedCommands


    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            if NamedCommands.hasCommand("shoot"):
                raise RuntimeError("it is configured already")
            self.shots = 0
            NamedCommands.registerCommand("shoot", commands2.cmd.runOnce(self.shoot))

        def shoot(self):
            self.shots += 1
"""

ROBOTS = {"commands": COMMANDS, "magic": MAGIC, "devices": DEVICES, "rev": REV, "pathplannerlib": PATHS}


def hashes(project: RobotProject, isolation: str) -> tuple[dict[str, str], str]:
    """Run the tests, or the ready-made ones; return the hash of each trace, and what is printed."""
    result = project.run("test", "--builtin", "-j", "1", "--trace", isolation, "--isolation", isolation, "--", "-v")
    assert result.code == 0, result.output
    traces = sorted((project.path / isolation).iterdir())
    return {file.name: file.read_text().splitlines()[-1] for file in traces}, result.output


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(list(ROBOTS), "commands"))
def test_one_interpreter_runs_all_tests(name: str, make_project: MakeProject) -> None:
    if name in ("rev", "pathplannerlib"):
        pytest.importorskip(name)
    project = make_project({"robot.py": ROBOTS[name]})
    forked, _ = hashes(project, "fork")
    reused, printed = hashes(project, "reuse")
    assert reused == forked
    assert len(forked) == 4
    assert re.findall("pyfrc: .*", printed) == []


@pytest.mark.slow
def test_the_fuzz_test_has_the_same_inputs_in_a_fork(make_project: MakeProject) -> None:
    project = make_project({"robot.py": MAGIC, "tests/test_fuzz.py": "from pyfrc.tests.fuzz_test import *\n"})
    assert hashes(project, "fork")[0] == hashes(project, "reuse")[0]
