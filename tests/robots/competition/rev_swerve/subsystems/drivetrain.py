"""The swerve drive: modules, gyro, pose estimation, path following."""

import math
from collections.abc import Callable

import commands2
import navx
import ntcore
import wpilib
from commands2.sysid import SysIdRoutine
from pathplannerlib.auto import AutoBuilder
from pathplannerlib.config import PIDConstants, RobotConfig
from pathplannerlib.controller import PPHolonomicDriveController
from pathplannerlib.logging import PathPlannerLogging
from pathplannerlib.util import DriveFeedforwards
from wpilib.sysid import SysIdRoutineLog
from wpimath.estimator import SwerveDrive4PoseEstimator
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import ChassisSpeeds, SwerveModuleState

from constants import CanIds, Drive, Vision
from subsystems.swervemodule import SwerveModule


def is_red() -> bool:
    """Return whether the driver station says that the robot is in the red alliance."""
    return wpilib.DriverStation.getAlliance() == wpilib.DriverStation.Alliance.kRed


class Drivetrain(commands2.Subsystem):
    """Drives in any direction and knows where it is on the field. All poses have the blue alliance's origin."""

    def __init__(self) -> None:
        super().__init__()
        self.modules = [
            SwerveModule(*settings)
            for settings in zip(Drive.MODULE_NAMES, CanIds.DRIVING, CanIds.TURNING, Drive.ANGULAR_OFFSETS, strict=True)
        ]
        self.gyro = navx.AHRS(navx.AHRS.NavXComType.kMXP_SPI)
        self.estimator = SwerveDrive4PoseEstimator(Drive.KINEMATICS, self.heading(), self.module_positions(), Pose2d())
        self.slow = False
        self.poses_reset = 0  # lets the simulation follow a reset
        self.desired_speeds = ChassisSpeeds()

        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Field", self.field)
        wpilib.SmartDashboard.putData("Gyro", self.gyro)
        table = ntcore.NetworkTableInstance.getDefault().getTable("Drivetrain")
        self.pose_publisher = table.getStructTopic("Pose", Pose2d).publish()
        self.measured_publisher = table.getStructArrayTopic("Measured", SwerveModuleState).publish()
        self.desired_publisher = table.getStructArrayTopic("Desired", SwerveModuleState).publish()
        self.gyro_alert = wpilib.Alert("The gyro is not connected", wpilib.Alert.AlertType.kError)
        self.module_alerts = [
            wpilib.Alert(f"{module.name} has a fault", wpilib.Alert.AlertType.kWarning) for module in self.modules
        ]

        self.configure_paths()
        self.sysid = SysIdRoutine(
            SysIdRoutine.Config(), SysIdRoutine.Mechanism(self.drive_volts, self.log_motors, self)
        )

    def configure_paths(self) -> None:
        """Let PathPlanner drive."""
        AutoBuilder.configure(
            self.pose,
            self.reset_pose,
            self.speeds,
            self.follow,
            PPHolonomicDriveController(PIDConstants(Drive.AUTO_TRANSLATION_KP), PIDConstants(Drive.AUTO_ROTATION_KP)),
            RobotConfig.fromGUISettings(),
            is_red,
            self,
        )
        PathPlannerLogging.setLogTargetPoseCallback(self.field.getObject("target").setPose)
        PathPlannerLogging.setLogActivePathCallback(lambda poses: self.field.getObject("path").setPoses(poses))

    # What it measures

    def heading(self) -> Rotation2d:
        """Return the gyro's angle."""
        return self.gyro.getRotation2d()

    def pose(self) -> Pose2d:
        """Return where the robot probably is."""
        return self.estimator.getEstimatedPosition()

    def module_positions(self) -> tuple:
        """Return the distances and directions of the four modules."""
        return tuple(module.position() for module in self.modules)

    def module_states(self) -> tuple:
        """Return the speeds and directions of the four modules."""
        return tuple(module.state() for module in self.modules)

    def speeds(self) -> ChassisSpeeds:
        """Return the measured speeds, relative to the robot."""
        return Drive.KINEMATICS.toChassisSpeeds(self.module_states())

    def reset_pose(self, pose: Pose2d) -> None:
        """Set where the robot is."""
        self.estimator.resetPosition(self.heading(), self.module_positions(), pose)
        self.poses_reset += 1

    def add_vision(self, pose: Pose2d, timestamp: float) -> None:
        """Correct the pose with a measurement of the camera."""
        self.estimator.addVisionMeasurement(pose, timestamp, Vision.STANDARD_DEVIATIONS)

    # What it does

    def drive(self, speeds: ChassisSpeeds) -> None:
        """Drive with these speeds, relative to the robot."""
        self.desired_speeds = ChassisSpeeds.discretize(speeds, 0.02)
        states = Drive.KINEMATICS.toSwerveModuleStates(self.desired_speeds)
        states = Drive.KINEMATICS.desaturateWheelSpeeds(states, Drive.MAX_SPEED)
        for module, state in zip(self.modules, states, strict=True):
            module.set_desired(state)

    def follow(self, speeds: ChassisSpeeds, feedforwards: DriveFeedforwards) -> None:
        """Drive as PathPlanner says."""
        self.drive(speeds)

    def drive_field_relative(self, vx: float, vy: float, omega: float) -> None:
        """Drive with these speeds as the driver sees them from behind the alliance's wall."""
        if is_red():
            vx, vy = -vx, -vy
        self.drive(ChassisSpeeds.fromFieldRelativeSpeeds(vx, vy, omega, self.pose().rotation()))

    def stop(self) -> None:
        """Stop all motors."""
        self.desired_speeds = ChassisSpeeds()
        for module in self.modules:
            module.stop()

    def drive_volts(self, volts: float) -> None:
        """Drive straight ahead with this voltage, to identify the drivetrain."""
        for module in self.modules:
            module.set_desired(SwerveModuleState(0, Rotation2d()))
            module.driving_motor.setVoltage(volts)

    def log_motors(self, log: SysIdRoutineLog) -> None:
        """Log what identifies the drivetrain."""
        for module in self.modules:
            log.motor(module.name).voltage(
                module.driving_motor.getAppliedOutput() * module.driving_motor.getBusVoltage()
            ).position(module.driving_encoder.getPosition()).velocity(module.driving_encoder.getVelocity())

    # Commands

    def lock_wheels(self) -> commands2.Command:
        """Return a command that turns the wheels into an X, so that the robot cannot be pushed."""

        def lock() -> None:
            for module, degrees in zip(self.modules, (45, -45, -45, 45), strict=True):
                module.set_desired(SwerveModuleState(0, Rotation2d.fromDegrees(degrees)))

        return self.run(lock).withName("LockWheels")

    def zero_heading(self) -> commands2.Command:
        """Return a command that makes the current direction the driver's forward."""

        def zero() -> None:
            away = Rotation2d(math.pi) if is_red() else Rotation2d()
            self.reset_pose(Pose2d(self.pose().translation(), away))

        return self.runOnce(zero).ignoringDisable(True).withName("ZeroHeading")

    def drive_slowly(self) -> commands2.Command:
        """Return a command during which the sticks are less sensitive."""
        return commands2.cmd.startEnd(lambda: setattr(self, "slow", True), lambda: setattr(self, "slow", False))

    def drive_with(self, speeds: Callable[[], ChassisSpeeds]) -> commands2.Command:
        """Return a command that drives with the speeds that a function returns."""
        return self.run(lambda: self.drive(speeds())).finallyDo(lambda interrupted: self.stop())

    def periodic(self) -> None:
        """Follow the wheels, and publish everything."""
        pose = self.estimator.update(self.heading(), self.module_positions())
        self.field.setRobotPose(pose)
        self.pose_publisher.set(pose)
        self.measured_publisher.set(list(self.module_states()))
        self.desired_publisher.set([module.desired for module in self.modules])
        self.gyro_alert.set(not self.gyro.isConnected())
        for module, alert in zip(self.modules, self.module_alerts, strict=True):
            alert.set(module.has_fault())
