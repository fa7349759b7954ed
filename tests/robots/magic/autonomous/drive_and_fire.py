"""The default autonomous mode."""

from components.drivetrain import Drivetrain
from components.launcher import LauncherControl
from magicbot import AutonomousStateMachine, state, timed_state


class DriveAndFire(AutonomousStateMachine):
    """Drives forward for two seconds, then throws the ball it was loaded with."""

    MODE_NAME = "Drive and fire"
    DEFAULT = True

    drivetrain: Drivetrain
    launcher_control: LauncherControl

    @timed_state(duration=1.99, first=True, next_state="fire")
    def drive(self) -> None:
        """Leave the starting line."""
        self.drivetrain.go(0.5)

    @state
    def fire(self) -> None:
        """Throw one ball, then stand still."""
        if self.launcher_control.thrown == 0:
            self.launcher_control.fire()
        else:
            self.done()
