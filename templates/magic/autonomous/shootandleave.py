"""Shoot the ball that the robot starts with, then leave the starting line."""

from magicbot import AutonomousStateMachine, timed_state

from components.drivetrain import Drivetrain
from components.shootercontrol import ShooterControl


class ShootAndLeave(AutonomousStateMachine):
    """Each method is a step, and runs every 20 ms for as long as the step is."""

    MODE_NAME = "Shoot and leave"
    DEFAULT = True

    shooter_control: ShooterControl
    drivetrain: Drivetrain

    @timed_state(duration=4, first=True, next_state="leave")
    def shoot(self) -> None:
        """Shoot for four seconds."""
        self.shooter_control.fire()

    @timed_state(duration=2)
    def leave(self) -> None:
        """Drive back for two seconds."""
        self.drivetrain.go(-0.4, 0.0)
