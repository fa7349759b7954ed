"""Drive straight to a pose with a profiled controller for each axis."""

import math

from commands2 import Command
from wpimath.controller import ProfiledPIDController, ProfiledPIDControllerRadians
from wpimath.geometry import Pose2d
from wpimath.kinematics import ChassisSpeeds
from wpimath.trajectory import TrapezoidProfile, TrapezoidProfileRadians

from subsystems.drivetrain import Drivetrain


class DriveToPose(Command):
    """Ends at the pose, or when interrupted."""

    def __init__(self, drivetrain: Drivetrain, target: Pose2d, max_speed: float = 3.0) -> None:
        super().__init__()
        self.drivetrain = drivetrain
        self.target = target
        constraints = TrapezoidProfile.Constraints(max_speed, 3.5)
        self.x = ProfiledPIDController(2.5, 0, 0, constraints)
        self.y = ProfiledPIDController(2.5, 0, 0, constraints)
        self.turn = ProfiledPIDControllerRadians(3.0, 0, 0, TrapezoidProfileRadians.Constraints(math.pi, 2 * math.pi))
        self.turn.enableContinuousInput(-math.pi, math.pi)
        self.addRequirements(drivetrain)

    def initialize(self) -> None:
        """Begin where the robot is, with its speed."""
        pose = self.drivetrain.pose()
        speeds = ChassisSpeeds.fromRobotRelativeSpeeds(self.drivetrain.speeds(), pose.rotation())
        self.x.reset(pose.x, speeds.vx)
        self.y.reset(pose.y, speeds.vy)
        self.turn.reset(pose.rotation().radians(), speeds.omega)

    def execute(self) -> None:
        """Follow the three profiles."""
        pose = self.drivetrain.pose()
        vx = self.x.calculate(pose.x, self.target.x) + self.x.getSetpoint().velocity
        vy = self.y.calculate(pose.y, self.target.y) + self.y.getSetpoint().velocity
        omega = self.turn.calculate(pose.rotation().radians(), self.target.rotation().radians())
        omega += self.turn.getSetpoint().velocity
        self.drivetrain.drive_on_field(ChassisSpeeds(vx, vy, omega))

    def end(self, interrupted: bool) -> None:
        """Stop."""
        self.drivetrain.stop()

    def isFinished(self) -> bool:
        """Return whether the robot is within 4 cm and 3 degrees."""
        error = self.target.relativeTo(self.drivetrain.pose())
        return error.translation().norm() < 0.04 and abs(error.rotation().degrees()) < 3
