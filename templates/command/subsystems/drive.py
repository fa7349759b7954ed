"""The drivetrain: a motor on each side, an encoder on each, and a gyro."""

from collections.abc import Callable

import commands2
import wpilib
import wpilib.drive

WHEEL_CIRCUMFERENCE = 0.48  # in metres
COUNTS_PER_TURN = 2048


class Drive(commands2.Subsystem):
    """Drive, and measure the distance."""

    def __init__(self) -> None:
        super().__init__()
        self.left_motor = wpilib.PWMSparkMax(0)
        self.right_motor = wpilib.PWMSparkMax(1)
        self.right_motor.setInverted(True)  # the motors face each other
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)

        self.left_encoder = wpilib.Encoder(0, 1)
        self.right_encoder = wpilib.Encoder(2, 3)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.setDistancePerPulse(WHEEL_CIRCUMFERENCE / COUNTS_PER_TURN)
        self.gyro = wpilib.ADXRS450_Gyro()

    def periodic(self) -> None:
        """Called by the scheduler every 20 ms: show the measurements to the driver."""
        wpilib.SmartDashboard.putNumber("Distance", self.distance())
        wpilib.SmartDashboard.putNumber("Heading", self.heading())

    def distance(self) -> float:
        """Return how far the robot has driven, in metres."""
        return (self.left_encoder.getDistance() + self.right_encoder.getDistance()) / 2

    def heading(self) -> float:
        """Return the heading in degrees, counter-clockwise."""
        return -self.gyro.getAngle()

    def go(self, forward: float, turn: float) -> None:
        """Drive for the next 20 ms. Both values are from -1 to 1; a turn to the left is positive."""
        self.drive.arcadeDrive(forward, turn, squareInputs=False)

    def stop(self) -> None:
        """Stop both motors."""
        self.drive.stopMotor()

    def arcade(self, forward: Callable[[], float], turn: Callable[[], float]) -> commands2.Command:
        """Return a command that drives with the values of these two functions."""
        return self.runEnd(lambda: self.go(forward(), turn()), self.stop)
