"""Physics of the robot in tests and in the simulator: four swerve wheels and their encoders.

The gyro turns with the robot. The numbers describe a typical robot. Replace them with your robot's.
"""

import math

from pyfrc.physics.core import PhysicsInterface
from pyfrc.physics.encoders import EncoderShaft
from wpilib.simulation import AnalogEncoderSim, PWMSim
from wpimath.geometry import Rotation2d
from wpimath.kinematics import SwerveModuleState

from robot import MyRobot
from swervemodule import MAX_SPEED, SwerveModule

MAX_WHEEL_TURNING = 4 * math.pi  # of a module's wheel at full power, in rad/s


class ModulePhysics:
    """The wheel of one module: its motors move it, and it moves the encoders."""

    def __init__(self, module: SwerveModule) -> None:
        self.drive_motor = PWMSim(module.drive_motor)
        self.turn_motor = PWMSim(module.turn_motor)
        self.drive_encoder = EncoderShaft(module.drive_encoder)
        self.angle_encoder = AnalogEncoderSim(module.angle_encoder)
        self.angle = 0.0  # in radians, counter-clockwise
        self.rolled = 0.0  # in metres

    def move(self, tm_diff: float) -> SwerveModuleState:
        """Turn and roll for `tm_diff` seconds. Return how the wheel moved."""
        speed = self.drive_motor.getSpeed() * MAX_SPEED
        self.angle += self.turn_motor.getSpeed() * MAX_WHEEL_TURNING * tm_diff
        self.rolled += speed * tm_diff
        self.drive_encoder.turn_to(self.rolled, speed)
        self.angle_encoder.set(self.angle % math.tau)
        return SwerveModuleState(speed, Rotation2d(self.angle))


class PhysicsEngine:
    """Move the robot according to its wheels. Created after the robot."""

    def __init__(self, physics_controller: PhysicsInterface, robot: MyRobot) -> None:
        self.physics_controller = physics_controller
        self.kinematics = robot.drivetrain.kinematics
        self.front_left, self.front_right, self.rear_left, self.rear_right = map(
            ModulePhysics, robot.drivetrain.modules
        )
        physics_controller.add_device_gyro_channel("adxrs450_spi_0_angle")  # turns with the robot

    def update_sim(self, now: float, tm_diff: float) -> None:
        """Called every 20 ms; `tm_diff` is the time since the last call, in seconds."""
        # If the four wheels do not agree, they slip. WPILib computes the movement that fits them best.
        speeds = self.kinematics.toChassisSpeeds(
            (
                self.front_left.move(tm_diff),
                self.front_right.move(tm_diff),
                self.rear_left.move(tm_diff),
                self.rear_right.move(tm_diff),
            )
        )
        self.physics_controller.drive(speeds, tm_diff)
