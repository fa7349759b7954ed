"""Projects that were written for other versions of pyfrc, which run as they are."""

from __future__ import annotations

OF_2019 = {
    "robot.py": """
import wpilib
import wpilib.drive


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.left, self.right = wpilib.Talon(0), wpilib.Talon(1)
        self.right.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left, self.right)
        self.gyro = wpilib.ADXRS450_Gyro()
        self.stick = wpilib.Joystick(0)

    def autonomousPeriodic(self):
        self.drive.arcadeDrive(0.6, 0.6 if self.gyro.getAngle() > -90 else 0)

    def teleopPeriodic(self):
        self.drive.arcadeDrive(-self.stick.getY(), -self.stick.getX())
""",
    "tests/pyfrc_test.py": """
from pyfrc.tests import *
""",
    "tests/test_drive.py": """
def test_turns_left_in_autonomous(control, fake_time, hal_data, robot):
    control.set_autonomous(enabled=True)
    control.run_test(lambda tm: tm < 5)
    assert fake_time.get() == 5
    assert -100 < hal_data["robot"]["adxrs450_spi_0_angle"] < -90


def test_full_speed_ahead(control, hal_data):
    class Driver:
        def on_step(self, tm):
            hal_data["joysticks"][0]["axes"][1] = -1.0
            return tm < 1

    control.set_operator_control(enabled=True)
    control.run_test(Driver)
    assert hal_data["pwm"][0]["value"] == 1.0
""",
    "physics.py": """
from pyfrc.physics import drivetrains


class PhysicsEngine:
    def __init__(self, physics_controller):
        self.physics_controller = physics_controller
        self.physics_controller.add_device_gyro_channel("adxrs450_spi_0_angle")
        self.drivetrain = drivetrains.TwoMotorDrivetrain(deadzone=drivetrains.linear_deadzone(0.2))

    def update_sim(self, hal_data, now, tm_diff):
        l_motor = -hal_data["pwm"][0]["value"]  # the drivetrain's left side is forward at -1, this robot's at 1
        r_motor = -hal_data["pwm"][1]["value"]
        speed, rotation = self.drivetrain.get_vector(l_motor, r_motor)
        self.physics_controller.drive(speed, rotation, tm_diff)
""",
    "sim/config.json": """
{
  "pyfrc": {
    "robot": {"w": 2, "h": 3, "starting_x": 2, "starting_y": 20, "starting_angle": 0},
    "field": {"w": 25, "h": 27, "px_per_ft": 15},
    "pwm": {"0": "Left", "1": "Right"}
  }
}
""",
}
OF_TODAY = {
    "robot.py": """
import wpilib


class MyRobot(wpilib.TimedRobot):
    def robotInit(self):
        self.left, self.right = wpilib.PWMSparkMax(1), wpilib.PWMSparkMax(2)
        self.stick = wpilib.Joystick(0)

    def autonomousPeriodic(self):
        self.left.set(0.5)
        self.right.set(-0.5)

    def teleopPeriodic(self):
        self.left.set(-self.stick.getY())
        self.right.set(self.stick.getY())
""",
    "physics.py": """
import wpilib.simulation
from pyfrc.physics import drivetrains
from pyfrc.physics.units import units


class PhysicsEngine:
    def __init__(self, physics_controller, robot):
        self.physics_controller = physics_controller
        self.l_motor = wpilib.simulation.PWMSim(robot.left.getChannel())
        self.r_motor = wpilib.simulation.PWMSim(robot.right.getChannel())
        self.drivetrain = drivetrains.TwoMotorDrivetrain(
            x_wheelbase=2 * units.feet, speed=5 * units.feet / units.second
        )

    def update_sim(self, now, tm_diff):
        speeds = self.drivetrain.calculate(self.l_motor.getSpeed(), self.r_motor.getSpeed())
        self.physics_controller.drive(speeds, tm_diff)
""",
    "tests/pyfrc_test.py": """
from pyfrc.tests import *
""",
    "tests/test_drive.py": """
import wpilib.simulation


def test_autonomous_drives_forward(control, robot, physics_controller):
    before = physics_controller.get_pose()
    with control.run_robot():
        control.step_timing(seconds=0.5, autonomous=True, enabled=False)
        assert control.step_timing(seconds=2, autonomous=True, enabled=True) == 2.0
        assert control.robot_is_alive
        driven = physics_controller.get_pose().relativeTo(before)
    assert 1.5 < driven.X() < 1.6


def test_the_stick(control, robot):
    stick = wpilib.simulation.JoystickSim(0)
    with control.run_robot():
        stick.setY(-1)
        stick.notifyNewData()
        control.step_timing(seconds=0.1, autonomous=False, enabled=True)
        assert robot.left.get() == 1
""",
}
