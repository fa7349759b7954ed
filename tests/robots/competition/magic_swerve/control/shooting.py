"""Aim at the hub, spin up, feed."""

from components.indexer import Indexer
from components.shooter import Shooter
from components.swerve import Swerve
from constants import FIELD_LENGTH, HUB
from magicbot import StateMachine, feedback, state, timed_state, tunable, will_reset_to
from wpilib import DriverStation
from wpimath.geometry import Translation2d


class ShootControl(StateMachine):
    """While `shoot` is called, balls fly as long as there are any."""

    swerve: Swerve
    shooter: Shooter
    indexer: Indexer

    patience = tunable(2.5)

    x = will_reset_to(0.0)
    y = will_reset_to(0.0)

    def shoot(self, x: float = 0.0, y: float = 0.0) -> None:
        """Shoot; drive at `x` and `y` (m/s) meanwhile. Call it in each loop."""
        self.x, self.y = x, y
        self.engage()

    def hub(self) -> Translation2d:
        """Return where this alliance's hub is."""
        if DriverStation.getAlliance() == DriverStation.Alliance.kRed:
            return Translation2d(FIELD_LENGTH - HUB.X(), HUB.Y())
        return HUB

    @feedback
    def get_distance(self) -> float:
        return self.swerve.pose().translation().distance(self.hub())

    def track(self) -> bool:
        """Turn to the hub and spin up; return whether a ball would hit."""
        direction = (self.hub() - self.swerve.pose().translation()).angle()
        self.swerve.drive_facing(self.x, self.y, direction)
        self.shooter.aim(self.get_distance())
        return self.swerve.faces(direction) and self.shooter.is_ready()

    @state(first=True)
    def aim(self, state_tm: float) -> None:
        """Wait for the wheels and the direction; shoot anyway if they do not come."""
        if self.track() or state_tm > self.patience:
            self.next_state("feed")

    @state
    def feed(self, state_tm: float) -> None:
        """Feed until the hopper has been empty for a moment."""
        self.track()
        self.indexer.feed()
        if self.indexer.balls == 0 and state_tm > 0.5:
            self.next_state("clear")

    @timed_state(duration=0.4, must_finish=True)
    def clear(self) -> None:
        """Run the belt a little longer: the count may be wrong."""
        self.track()
        self.indexer.feed()
