"""Shoot and climb."""

from constants import TOWER
from control.climbing import ClimbControl
from magicbot import state, timed_state

from autonomous.base import Routine


class ShootAndClimb(Routine):
    """For matches in which the alliance counts on the tower."""

    MODE_NAME = "Shoot and climb"

    climb_control: ClimbControl

    @timed_state(duration=5.0, first=True, next_state="to_tower")
    def shoot(self) -> None:
        """Shoot all."""
        self.shoot_control.shoot(-0.5, 0)
        if self.shoot_control.indexer.balls == 0:
            self.next_state("to_tower")

    @timed_state(duration=5.0, next_state="lift")
    def to_tower(self) -> None:
        """Drive to the tower, and raise the hook on the way."""
        self.climb_control.prepare()
        if self.swerve.drive_to(self.own(TOWER)):
            self.next_state("lift")

    @state
    def lift(self) -> None:
        """Lift the robot when the hook is up."""
        self.climb_control.lift()
        if self.climb_control.lifted:
            self.done()
        elif not self.climb_control.is_executing:
            self.climb_control.prepare()
