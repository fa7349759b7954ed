"""The swerve drive: four modules, a Pigeon2, and an estimate of where the robot is."""

import math
from collections.abc import Callable

from commands2 import Command, Subsystem
from commands2.sysid import SysIdRoutine
from phoenix6 import BaseStatusSignal, SignalLogger
from phoenix6.configs import Pigeon2Configuration
from phoenix6.hardware import Pigeon2
from wpilib import DriverStation, Field2d, SmartDashboard
from wpilib.sysid import State, SysIdRoutineLog
from wpimath.controller import ProfiledPIDControllerRadians
from wpimath.estimator import SwerveDrive4PoseEstimator
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import ChassisSpeeds, SwerveDrive4Kinematics, SwerveModuleState
from wpimath.trajectory import TrapezoidProfileRadians
from wpimath.units import volts

from constants import Can, Swerve
from subsystems.devices import Connections, configure
from subsystems.swervemodule import SwerveModule


class Drivetrain(Subsystem):
    """Drives in any direction, and knows its pose."""

    def __init__(self) -> None:
        super().__init__()
        self.modules = tuple(SwerveModule(*module) for module in Swerve.MODULES)
        self.pigeon = Pigeon2(Can.PIGEON)
        configure(self.pigeon, Pigeon2Configuration())
        self.yaw = self.pigeon.get_yaw()
        self.yaw_rate = self.pigeon.get_angular_velocity_z_world()

        self.signals = [self.yaw, self.yaw_rate, *(signal for module in self.modules for signal in module.signals)]
        BaseStatusSignal.set_update_frequency_for_all(Swerve.ODOMETRY_FREQUENCY, self.signals)
        for device in (self.pigeon, *(device for module in self.modules for device in module.devices)):
            device.optimize_bus_utilization()
        self.connections = Connections(self.pigeon, *(device for module in self.modules for device in module.devices))

        self.kinematics = SwerveDrive4Kinematics(*Swerve.LOCATIONS)
        self.estimator = SwerveDrive4PoseEstimator(self.kinematics, self.heading(), self.module_positions(), Pose2d())
        self.heading_controller = ProfiledPIDControllerRadians(
            5.0, 0.0, 0.1, TrapezoidProfileRadians.Constraints(Swerve.MAX_TURNING, 4 * math.pi)
        )
        self.heading_controller.enableContinuousInput(-math.pi, math.pi)
        self.field = Field2d()
        SmartDashboard.putData("Field", self.field)
        self.sysid = SysIdRoutine(
            SysIdRoutine.Config(
                recordState=lambda state: SignalLogger.write_string("sysid-drive", str(state)) and None
            ),
            SysIdRoutine.Mechanism(self._drive_volts, lambda log: None, self),
        )

    def heading(self) -> Rotation2d:
        """Return what the gyro measures."""
        return Rotation2d.fromDegrees(
            BaseStatusSignal.get_latency_compensated_value(self.yaw, self.yaw_rate),
        )

    def module_positions(self):
        """Return how far each wheel has rolled, and its direction."""
        return tuple(module.position() for module in self.modules)

    def pose(self) -> Pose2d:
        """Return where the robot is on the field."""
        return self.estimator.getEstimatedPosition()

    def speeds(self) -> ChassisSpeeds:
        """Return how the robot moves, seen from itself."""
        return self.kinematics.toChassisSpeeds(tuple(module.state() for module in self.modules))

    def reset_pose(self, pose: Pose2d) -> None:
        """Take this as the robot's pose from now on."""
        self.estimator.resetPosition(self.heading(), self.module_positions(), pose)

    def periodic(self) -> None:
        """Refresh all signals together, and estimate the pose from them."""
        BaseStatusSignal.refresh_all(self.signals)
        self.connections.update()
        self.estimator.update(self.heading(), self.module_positions())
        pose = self.pose()
        # While no request turns the robot, the controller follows, so that a later one does not begin with a jump.
        if DriverStation.isDisabled():
            self.heading_controller.reset(pose.rotation().radians(), math.radians(self.yaw_rate.value))
        self.field.setRobotPose(pose)
        SmartDashboard.putNumber("Drive/Speed", math.hypot(self.speeds().vx, self.speeds().vy))
        SmartDashboard.putNumber("Drive/Heading", pose.rotation().degrees())
        for module in self.modules:
            SmartDashboard.putNumber(f"Drive/{module.name}/Angle", module.angle().degrees())
            SmartDashboard.putNumber(f"Drive/{module.name}/TargetSpeed", module.target.speed)

    def drive(self, speeds: ChassisSpeeds) -> None:
        """Move like this, seen from the robot."""
        discrete = ChassisSpeeds.discretize(speeds, 0.02)
        states = self.kinematics.toSwerveModuleStates(discrete)
        for module, state in zip(
            self.modules, SwerveDrive4Kinematics.desaturateWheelSpeeds(states, Swerve.MAX_SPEED), strict=True
        ):
            module.set_target(state)

    def drive_on_field(self, speeds: ChassisSpeeds) -> None:
        """Move like this, seen from the field."""
        self.drive(ChassisSpeeds.fromFieldRelativeSpeeds(speeds, self.pose().rotation()))

    def stop(self) -> None:
        """Stop all modules."""
        for module in self.modules:
            module.stop()

    def drive_with(
        self, forward: Callable[[], float], left: Callable[[], float], turn: Callable[[], float], slow: float = 1.0
    ) -> Command:
        """Return a command that drives with the sticks, from -1 to 1."""

        def execute() -> None:
            side = -1 if DriverStation.getAlliance() == DriverStation.Alliance.kRed else 1
            self.drive_on_field(
                ChassisSpeeds(
                    side * forward() * slow * Swerve.MAX_SPEED,
                    side * left() * slow * Swerve.MAX_SPEED,
                    turn() * slow * Swerve.MAX_TURNING,
                )
            )

        return self.runEnd(execute, self.stop).withName("Drive")

    def face(self, angle: Rotation2d, forward: Callable[[], float], left: Callable[[], float]) -> Command:
        """Return a command that turns to `angle` while the sticks drive."""

        def execute() -> None:
            turn = self.heading_controller.calculate(self.pose().rotation().radians(), angle.radians())
            turn += self.heading_controller.getSetpoint().velocity
            self.drive_on_field(ChassisSpeeds(forward() * Swerve.MAX_SPEED, left() * Swerve.MAX_SPEED, turn))

        def begin() -> None:
            self.heading_controller.reset(self.pose().rotation().radians(), math.radians(self.yaw_rate.value))

        return self.startRun(begin, execute).finallyDo(lambda interrupted: self.stop()).withName("Face")

    def cross(self) -> Command:
        """Return a command that turns the wheels into an X, which keeps other robots from pushing it."""

        def execute() -> None:
            for module, location in zip(self.modules, Swerve.LOCATIONS, strict=True):
                module.set_target(SwerveModuleState(0, location.angle()))

        return self.run(execute).withName("Cross")

    def _record_sysid(self, state: State) -> None:
        SignalLogger.write_string("sysid-drive", SysIdRoutineLog.stateEnumToString(state))

    def _drive_volts(self, output: volts) -> None:
        for module in self.modules:
            module.set_volts(output)
