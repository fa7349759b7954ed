"""The square robot's physics as written since 2020: metres, counter-clockwise, wpilib.simulation."""

import typing

from wpilib.simulation import AnalogGyroSim, EncoderSim, PWMSim

from pyfrc.physics import drivetrains
from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.units import units

if typing.TYPE_CHECKING:
    from robot import MyRobot

TICKS_PER_M = 360 / 0.3048


class PhysicsEngine:
    """A tank drive with encoders and a gyro."""

    def __init__(self, physics_controller: PhysicsInterface, robot: "MyRobot"):
        """The wheels are 2 ft apart, and go at 6 ft/s."""
        self.physics_controller = physics_controller
        self.l_motor = PWMSim(robot.left_motor.getChannel())
        self.r_motor = PWMSim(robot.right_motor.getChannel())
        self.l_encoder = EncoderSim(robot.left_encoder)
        self.r_encoder = EncoderSim(robot.right_encoder)
        self.gyro = AnalogGyroSim(robot.gyro)
        self.drivetrain = drivetrains.TwoMotorDrivetrain(
            x_wheelbase=2 * units.feet, speed=6 * units.fps, deadzone=drivetrains.linear_deadzone(0.02)
        )
        self.left = self.right = 0.0

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Motors to movement, movement to encoders and gyro."""
        speeds = self.drivetrain.calculate(self.l_motor.getSpeed(), self.r_motor.getSpeed())
        pose = self.physics_controller.drive(speeds, tm_diff)
        self.gyro.setAngle(-pose.rotation().degrees())

        left = self.drivetrain.wheelSpeeds.left * tm_diff
        right = self.drivetrain.wheelSpeeds.right * tm_diff
        self.count(self.l_encoder, self.left, left)
        self.count(self.r_encoder, self.right, right)
        self.left += left
        self.right += right

    def count(self, encoder: EncoderSim, before: float, distance: float) -> None:
        """The robot resets its encoders, so they are told what was added."""
        added = round((before + distance) * TICKS_PER_M) - round(before * TICKS_PER_M)
        encoder.setCount(encoder.getCount() + added)
