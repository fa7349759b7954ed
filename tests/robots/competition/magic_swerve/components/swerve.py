"""The drivetrain: where the robot is, and where it shall go."""

import math

import wpilib
from constants import MAX_ACCELERATION, MAX_SPEED, MAX_TURN_RATE
from magicbot import feedback, tunable, will_reset_to
from wpimath.controller import PIDController, ProfiledPIDControllerRadians
from wpimath.estimator import SwerveDrive4PoseEstimator
from wpimath.filter import SlewRateLimiter
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import ChassisSpeeds, SwerveDrive4Kinematics, SwerveModuleState
from wpimath.trajectory import TrapezoidProfileRadians

from .swerve_module import SwerveModule


class Swerve:
    """Four modules and a gyro."""

    gyro: wpilib.ADXRS450_Gyro
    modules: list[SwerveModule]
    field: wpilib.Field2d

    translation_kp = tunable(2.5)
    heading_kp = tunable(4.5)
    slow_factor = tunable(0.35)

    speeds = will_reset_to(ChassisSpeeds())
    locked = will_reset_to(False)
    slow = will_reset_to(False)

    def setup(self) -> None:
        """Create the controllers, once the modules are there."""
        self.kinematics = SwerveDrive4Kinematics(*(module.location for module in self.modules))
        self.estimator = SwerveDrive4PoseEstimator(self.kinematics, self.heading(), self.positions(), Pose2d())
        limits = TrapezoidProfileRadians.Constraints(MAX_TURN_RATE, 2 * MAX_TURN_RATE)
        self.heading_pid = ProfiledPIDControllerRadians(self.heading_kp, 0, 0.1, limits)
        self.heading_pid.enableContinuousInput(-math.pi, math.pi)
        self.distance_pid = PIDController(self.translation_kp, 0, 0)
        self.limiters = SlewRateLimiter(MAX_ACCELERATION), SlewRateLimiter(MAX_ACCELERATION)

    def on_enable(self) -> None:
        """Forget what the controllers were about to do."""
        self.heading_pid.reset(self.pose().rotation().radians())
        for limiter in self.limiters:
            limiter.reset(0)

    # -- where the robot is ------------------------------------------------------------------------------------------

    def heading(self) -> Rotation2d:
        """Return the gyro's angle, counter-clockwise."""
        return self.gyro.getRotation2d()

    def positions(self):
        """Return the four wheels' positions."""
        return tuple(module.position() for module in self.modules)

    def pose(self) -> Pose2d:
        """Return the estimated position on the field."""
        return self.estimator.getEstimatedPosition()

    def reset_pose(self, pose: Pose2d) -> None:
        """Take the robot to be at `pose`."""
        self.estimator.resetPosition(self.heading(), self.positions(), pose)
        self.heading_pid.reset(pose.rotation().radians())

    def update_odometry(self) -> None:
        """Follow the wheels: in each loop, also while disabled, when people push the robot."""
        self.estimator.update(self.heading(), self.positions())
        self.field.setRobotPose(self.pose())

    @feedback
    def get_x(self) -> float:
        return self.pose().X()

    @feedback
    def get_y(self) -> float:
        return self.pose().Y()

    @feedback
    def get_degrees(self) -> float:
        return self.pose().rotation().degrees()

    @feedback
    def get_wheel_speeds(self) -> list[float]:
        return [module.state().speed for module in self.modules]

    @feedback
    def get_steering(self) -> list[float]:
        return [module.angle().degrees() for module in self.modules]

    # -- where it shall go -------------------------------------------------------------------------------------------

    def drive_robot(self, forward: float, left: float, turn: float) -> None:
        """Drive as seen from the robot (m/s, rad/s)."""
        self.speeds = ChassisSpeeds(forward, left, turn)

    def drive_field(self, x: float, y: float, turn: float) -> None:
        """Drive as seen from the blue alliance's wall (m/s, rad/s), no harder than the carpet holds."""
        x, y = (limiter.calculate(value) for limiter, value in zip(self.limiters, (x, y), strict=True))
        self.speeds = ChassisSpeeds.fromFieldRelativeSpeeds(x, y, turn, self.pose().rotation())

    def drive_facing(self, x: float, y: float, direction: Rotation2d) -> None:
        """Drive as seen from the field, and turn towards a direction meanwhile."""
        self.heading_pid.setP(self.heading_kp)
        turn = self.heading_pid.calculate(self.pose().rotation().radians(), direction.radians())
        self.drive_field(x, y, turn + self.heading_pid.getSetpoint().velocity)

    def drive_to(self, goal: Pose2d, max_speed: float = 3.0) -> bool:
        """Drive to a place on the field; return whether the robot is there."""
        here = self.pose()
        offset = goal.translation() - here.translation()
        self.distance_pid.setP(self.translation_kp)
        speed = min(max_speed, -self.distance_pid.calculate(offset.norm(), 0))
        direction = offset.angle()
        self.drive_facing(speed * direction.cos(), speed * direction.sin(), goal.rotation())
        turned = (goal.rotation() - here.rotation()).degrees()
        return offset.norm() < 0.05 and abs(turned) < 2.5

    def faces(self, direction: Rotation2d) -> bool:
        """Return whether the robot looks into a direction."""
        return abs((direction - self.pose().rotation()).degrees()) < 2.5

    def lock(self) -> None:
        """Turn the wheels so that the robot cannot be pushed."""
        self.locked = True

    def execute(self) -> None:
        """Move the wheels."""
        if self.locked:
            for module in self.modules:
                module.set(SwerveModuleState(0, module.location.angle()))
            return
        speeds = self.speeds * self.slow_factor if self.slow else self.speeds
        speeds = ChassisSpeeds.discretize(speeds, 0.02)
        if max(abs(speeds.vx), abs(speeds.vy)) < 0.01 and abs(speeds.omega) < 0.01:
            for module in self.modules:
                module.set(SwerveModuleState(0, module.angle()))
            return
        states = self.kinematics.toSwerveModuleStates(speeds)
        states = self.kinematics.desaturateWheelSpeeds(states, MAX_SPEED)
        for module, state in zip(self.modules, states, strict=True):
            module.set(state)

    def on_disable(self) -> None:
        """Stop all motors."""
        for module in self.modules:
            module.stop()
