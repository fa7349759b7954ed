"""What all autonomous modes share."""

import wpilib
from components.swerve import Swerve
from constants import FIELD_LENGTH, STARTS
from control.collecting import CollectControl
from control.shooting import ShootControl
from magicbot import AutonomousStateMachine
from wpimath.geometry import Pose2d, Rotation2d


class Routine(AutonomousStateMachine):
    """Begins at the place that was chosen, on the alliance's own side. Without a MODE_NAME, it is no mode."""

    swerve: Swerve
    shoot_control: ShootControl
    collect_control: CollectControl
    start_chooser: wpilib.SendableChooser

    def on_enable(self) -> None:
        """Take the robot to be where it was put."""
        self.swerve.reset_pose(self.own(STARTS[self.start_chooser.getSelected() or "Center"]))
        super().on_enable()

    def own(self, pose: Pose2d) -> Pose2d:
        """Return this alliance's counterpart of a blue pose."""
        if wpilib.DriverStation.getAlliance() == wpilib.DriverStation.Alliance.kRed:
            return Pose2d(FIELD_LENGTH - pose.X(), pose.Y(), Rotation2d.fromDegrees(180) - pose.rotation())
        return pose
