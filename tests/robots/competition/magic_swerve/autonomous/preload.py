"""Shoot what the robot is loaded with."""

from magicbot import state, timed_state
from wpimath.geometry import Pose2d, Rotation2d

from autonomous.base import Routine


class Preload(Routine):
    """The default: three balls, then out of the way."""

    MODE_NAME = "Preload"
    DEFAULT = True

    @timed_state(duration=1.2, first=True, next_state="shoot")
    def back_up(self) -> None:
        """Get away from the hub."""
        self.swerve.drive_to(self.own(Pose2d(2.4, 4.6, Rotation2d.fromDegrees(-20))), max_speed=2.0)

    @timed_state(duration=5.0, next_state="leave")
    def shoot(self) -> None:
        """Shoot all."""
        self.shoot_control.shoot()
        if self.shoot_control.indexer.balls == 0:
            self.next_state("leave")

    @state
    def leave(self) -> None:
        """Make room for the others."""
        if self.swerve.drive_to(self.own(Pose2d(1.6, 6.5, Rotation2d()))):
            self.done()
