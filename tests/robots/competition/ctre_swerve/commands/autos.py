"""The autonomous routines, and the choice between them."""

import math

from commands2 import Command, cmd
from wpilib import SendableChooser
from wpimath.controller import HolonomicDriveController, PIDController, ProfiledPIDControllerRadians
from wpimath.geometry import Pose2d, Rotation2d, Translation2d
from wpimath.trajectory import Trajectory, TrajectoryConfig, TrajectoryGenerator, TrapezoidProfileRadians

from commands.drivetopose import DriveToPose
from commands.superstructure import Superstructure
from subsystems.drivetrain import Drivetrain

START = Pose2d(1.5, 5.5, Rotation2d())


class FollowTrajectory(Command):
    """Drive along a trajectory, facing one way."""

    def __init__(self, drivetrain: Drivetrain, trajectory: Trajectory, heading: Rotation2d) -> None:
        super().__init__()
        self.drivetrain = drivetrain
        self.trajectory = trajectory
        self.heading = heading
        turn = ProfiledPIDControllerRadians(3, 0, 0, TrapezoidProfileRadians.Constraints(math.pi, 2 * math.pi))
        turn.enableContinuousInput(-math.pi, math.pi)
        self.controller = HolonomicDriveController(PIDController(2, 0, 0), PIDController(2, 0, 0), turn)
        self.loops = 0
        self.addRequirements(drivetrain)

    def initialize(self) -> None:
        """Begin at the first state."""
        self.loops = 0

    def execute(self) -> None:
        """Follow the state of this loop."""
        self.loops += 1
        state = self.trajectory.sample(self.loops * 0.02)
        self.drivetrain.drive(self.controller.calculate(self.drivetrain.pose(), state, self.heading))

    def end(self, interrupted: bool) -> None:
        """Stop."""
        self.drivetrain.stop()

    def isFinished(self) -> bool:
        """Return whether the trajectory is over."""
        return self.loops * 0.02 >= self.trajectory.totalTime()


def _begin_at(drivetrain: Drivetrain, pose: Pose2d) -> Command:
    return cmd.runOnce(lambda: drivetrain.reset_pose(pose))


def leave(drivetrain: Drivetrain) -> Command:
    """Drive two metres ahead."""
    target = Pose2d(START.x + 2, START.y, START.rotation())
    return _begin_at(drivetrain, START).andThen(DriveToPose(drivetrain, target)).withName("Leave")


def two_pieces(drivetrain: Drivetrain, superstructure: Superstructure) -> Command:
    """Shoot, fetch the next piece, come back and shoot again."""
    piece = Pose2d(START.x + 1.5, START.y - 0.8, Rotation2d.fromDegrees(-30))
    return cmd.sequence(
        _begin_at(drivetrain, START),
        superstructure.shoot().withTimeout(2.5),
        cmd.deadline(DriveToPose(drivetrain, piece).withTimeout(3), superstructure.fetch()),
        DriveToPose(drivetrain, START).withTimeout(3),
        superstructure.shoot().withTimeout(2.5),
        superstructure.stow(),
    ).withName("Two pieces")


def sweep(drivetrain: Drivetrain, superstructure: Superstructure) -> Command:
    """Follow a curve through the middle with the intake out."""
    trajectory = TrajectoryGenerator.generateTrajectory(
        START,
        [Translation2d(START.x + 1.2, START.y - 0.9), Translation2d(START.x + 2.4, START.y - 1.2)],
        Pose2d(START.x + 3.5, START.y - 0.5, Rotation2d.fromDegrees(30)),
        TrajectoryConfig(2.5, 2.0),
    )
    return cmd.sequence(
        _begin_at(drivetrain, START),
        cmd.deadline(FollowTrajectory(drivetrain, trajectory, Rotation2d()), superstructure.fetch()),
        superstructure.stow(),
    ).withName("Sweep")


def chooser(drivetrain: Drivetrain, superstructure: Superstructure) -> SendableChooser:
    """Return the chooser for the dashboard."""
    options = SendableChooser()
    options.setDefaultOption("Two pieces", two_pieces(drivetrain, superstructure))
    options.addOption("Leave", leave(drivetrain))
    options.addOption("Sweep", sweep(drivetrain, superstructure))
    options.addOption("Nothing", cmd.none())
    return options
