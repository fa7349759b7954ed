"""The autonomous routines."""

import commands2
import commands2.cmd
from constants import Drive, Positions
from subsystems.drivetrain import Drivetrain
from subsystems.gripper import Gripper
from superstructure import Superstructure
from wpimath.geometry import Pose2d, Rotation2d, Translation2d
from wpimath.trajectory import Trajectory, TrajectoryConfig, TrajectoryGenerator
from wpimath.trajectory.constraint import CentripetalAccelerationConstraint


def curve(drivetrain: Drivetrain, side: int) -> Trajectory:
    """Return a trajectory from the start to the neutral zone, around the left (1) or the right (-1) side."""
    config = TrajectoryConfig(2.0, 1.4)
    config.setKinematics(drivetrain.kinematics)
    config.addConstraint(CentripetalAccelerationConstraint(1.5))
    end = Pose2d(Drive.START.X() + 3.2, Drive.START.Y() + side * 1.4, Rotation2d())
    between = [Translation2d(Drive.START.X() + 1.6, Drive.START.Y() + side * 0.8)]
    return TrajectoryGenerator.generateTrajectory(Drive.START, between, end, config)


def nothing() -> commands2.Command:
    """Stay."""
    return commands2.cmd.none().withName("Nothing")


def leave(drivetrain: Drivetrain) -> commands2.Command:
    """Drive out of the zone, and turn around."""
    return commands2.cmd.sequence(
        commands2.cmd.runOnce(lambda: drivetrain.reset_pose(Drive.START)),
        drivetrain.drive_distance(2.0).withTimeout(4),
        drivetrain.turn_to(90).withTimeout(3),
    ).withName("Leave")


def score_high(
    drivetrain: Drivetrain, superstructure: Superstructure, gripper: Gripper, side: int
) -> commands2.Command:
    """Follow a curve while the elevator goes up, put the piece down, and come home."""
    path = curve(drivetrain, side)
    up = superstructure.go_to(Positions.HIGH, "High")
    return commands2.cmd.sequence(
        commands2.cmd.runOnce(lambda: drivetrain.reset_pose(Drive.START)),
        commands2.cmd.runOnce(gripper.close, gripper),
        drivetrain.follow(path).alongWith(commands2.cmd.waitSeconds(0.5).andThen(up)).withTimeout(7),
        gripper.release(),
        superstructure.go_to(Positions.STOW, "Stow").withTimeout(4),
        drivetrain.drive_distance(-0.8).withTimeout(3),
    ).withName("Score high")
