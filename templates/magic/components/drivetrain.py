"""The drivetrain: a motor on each side."""

import wpilib
import wpilib.drive
from magicbot import will_reset_to


class Drivetrain:
    """Drives as it is told, and stops when nobody tells it anything."""

    left_motor: wpilib.PWMSparkMax
    right_motor: wpilib.PWMSparkMax

    # Every 20 ms, when execute has run, these are put back.
    forward = will_reset_to(0.0)
    turn = will_reset_to(0.0)

    def setup(self) -> None:
        """Called once, when the motors have been handed over."""
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)

    def go(self, forward: float, turn: float) -> None:
        """Drive for this moment; both are from -1 to 1, and a turn to the left is positive."""
        self.forward = forward
        self.turn = turn

    def execute(self) -> None:
        """Called every 20 ms while the robot is enabled."""
        self.drive.arcadeDrive(self.forward, self.turn, squareInputs=False)

    def on_disable(self) -> None:
        """Called once when the robot is disabled."""
        self.drive.stopMotor()
