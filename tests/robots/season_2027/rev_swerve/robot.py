"""A swerve drive on SPARK MAX, whose controllers close all loops; odometry with the IMU of the controller."""

import math

import rev
import wpilib
from wpimath import (
    ChassisVelocities,
    Rotation2d,
    SwerveDrive4Kinematics,
    SwerveDrive4Odometry,
    SwerveModulePosition,
    Translation2d,
)

BUS = wpilib.CANPort.CAN_S0
BRUSHLESS = rev.SparkMax.MotorType.BRUSHLESS
SAFELY = rev.ResetMode.RESET_SAFE_PARAMETERS, rev.PersistMode.PERSIST_PARAMETERS
METRES = math.pi * 0.1016 / 6.75  # of the wheel in one turn of its motor
MAX_SPEED = 4.0
PLACES = {
    "front_left": Translation2d(0.28, 0.28),
    "front_right": Translation2d(0.28, -0.28),
    "rear_left": Translation2d(-0.28, 0.28),
    "rear_right": Translation2d(-0.28, -0.28),
}


class Module:
    """A wheel, whose controllers drive and steer it in closed loops."""

    def __init__(self, number):
        self.drive = rev.SparkMax(BUS, 2 * number, BRUSHLESS)
        config = rev.SparkMaxConfig()
        config.closed_loop.pid(0.0001, 0, 0).feed_forward.v(12 / 5676)
        self.drive.configure(config, *SAFELY)
        self.steer = rev.SparkMax(BUS, 2 * number + 1, BRUSHLESS)
        config = rev.SparkMaxConfig()
        config.closed_loop.pid(2.0, 0, 0).set_feedback_sensor(rev.FeedbackSensor.ABSOLUTE_ENCODER)
        config.closed_loop.position_wrapping_enabled(True)
        self.steer.configure(config, *SAFELY)

    def angle(self):
        return Rotation2d.from_rotations(self.steer.get_absolute_encoder().get_position().get())

    def position(self):
        return SwerveModulePosition(self.drive.get_encoder().get_position().get() * METRES, self.angle())

    def set(self, wanted):
        wanted = wanted.optimize(self.angle())
        self.drive.get_closed_loop_controller().set_setpoint(
            wanted.velocity / METRES * 60, rev.SparkMax.ControlType.VELOCITY
        )
        self.steer.get_closed_loop_controller().set_setpoint(
            wanted.angle.degrees() / 360 % 1, rev.SparkMax.ControlType.POSITION
        )


class MyRobot(wpilib.TimedRobot):
    def __init__(self):
        super().__init__()
        self.modules = {name: Module(number) for number, name in enumerate(PLACES, 1)}
        self.kinematics = SwerveDrive4Kinematics(*PLACES.values())
        self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)
        self.odometry = SwerveDrive4Odometry(self.kinematics, self.imu.get_rotation2d(), self.positions())
        self.gamepad = wpilib.XboxController(0)

    def positions(self):
        return tuple(module.position() for module in self.modules.values())

    def robot_periodic(self):
        self.odometry.update(self.imu.get_rotation2d(), self.positions())

    def teleop_periodic(self):
        speeds = ChassisVelocities(
            -self.gamepad.get_left_y() * MAX_SPEED,
            -self.gamepad.get_left_x() * MAX_SPEED,
            -self.gamepad.get_right_x() * 4,
        )
        wheels = self.kinematics.to_swerve_module_velocities(speeds)
        for module, wheel in zip(self.modules.values(), wheels, strict=True):
            module.set(wheel)
