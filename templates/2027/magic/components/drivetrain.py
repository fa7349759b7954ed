"""The drivetrain: a motor on each side."""

import wpilib
import wpilib_drivers
from magicbot import will_reset_to


class Drivetrain:
    """Drive at the requested speeds, and stop when there is no request."""

    left_motor: wpilib_drivers.PWMSparkMax
    right_motor: wpilib_drivers.PWMSparkMax

    # magicbot resets these after each execute.
    forward = will_reset_to(0.0)
    turn = will_reset_to(0.0)

    def setup(self) -> None:
        """Called once, after magicbot has set the motors."""
        self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)

    def go(self, forward: float, turn: float) -> None:
        """Drive for the next 20 ms. Both values are from -1 to 1; a turn to the left is positive."""
        self.forward = forward
        self.turn = turn

    def execute(self) -> None:
        """Called every 20 ms while the robot is enabled."""
        self.drive.arcade_drive(self.forward, self.turn, square_inputs=False)

    def on_disable(self) -> None:
        """Called once when the robot is disabled."""
        self.drive.stop_motor()
