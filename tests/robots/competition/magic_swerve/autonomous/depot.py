"""Shoot, fetch more from the depot, shoot again."""

from constants import DEPOT
from magicbot import state, timed_state
from wpimath.geometry import Pose2d, Rotation2d

from autonomous.base import Routine


class Depot(Routine):
    """Two rounds of shooting."""

    MODE_NAME = "Depot"

    @timed_state(duration=4.0, first=True, next_state="to_depot")
    def shoot_first(self) -> None:
        """Shoot what the robot is loaded with, while moving to the depot's side."""
        self.shoot_control.shoot(-0.4, 0.4)
        if self.shoot_control.indexer.balls == 0:
            self.next_state("to_depot")

    @timed_state(duration=5.0, next_state="sweep")
    def to_depot(self) -> None:
        """Drive there, the intake ahead."""
        self.collect_control.collect()
        if self.swerve.drive_to(self.own(Pose2d(1.6, DEPOT.Y(), DEPOT.rotation()))):
            self.next_state("sweep")

    @timed_state(duration=2.5, next_state="back")
    def sweep(self) -> None:
        """Drive slowly through the balls."""
        self.collect_control.collect()
        self.swerve.drive_to(self.own(DEPOT), max_speed=0.8)

    @timed_state(duration=3.0, next_state="shoot_second")
    def back(self) -> None:
        """Drive to where the robot hits."""
        if self.swerve.drive_to(self.own(Pose2d(2.4, 5.2, Rotation2d.fromDegrees(-30)))):
            self.next_state("shoot_second")

    @state
    def shoot_second(self) -> None:
        """Shoot until the period ends."""
        self.shoot_control.shoot()
