"""The drivetrain: a motor on each side, an encoder on each, and a gyro."""

from collections.abc import Callable

import commands2
import telemetry
import wpilib
import wpilib_drivers
from wpimath import DifferentialDriveOdometry, Pose2d, Rotation2d

WHEEL_CIRCUMFERENCE = 0.48  # in metres
COUNTS_PER_TURN = 2048

# Where the robot starts: metres from the corner at the right of the blue drivers, as in sim/config.json.
START = Pose2d(3.05, 4.03, Rotation2d())


class Drive(commands2.Subsystem):
    """Drive, and measure the distance."""

    def __init__(self) -> None:
        super().__init__()
        self.left_motor = wpilib_drivers.PWMSparkMax(0)
        self.right_motor = wpilib_drivers.PWMSparkMax(1)
        self.right_motor.set_inverted(True)  # the motors face each other
        self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)

        self.left_encoder = wpilib.Encoder(0, 1)
        self.right_encoder = wpilib.Encoder(2, 3)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.set_distance_per_pulse(WHEEL_CIRCUMFERENCE / COUNTS_PER_TURN)
        self.gyro = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)

        # The field on the dashboard, with the robot where its wheels and its gyro say that it is.
        self.odometry = DifferentialDriveOdometry(self.gyro.get_rotation2d(), 0, 0, START)
        self.field = wpilib.Field2d()

    def periodic(self) -> None:
        """Called by the scheduler every 20 ms: show the measurements to the driver."""
        left, right = self.left_encoder.get_distance(), self.right_encoder.get_distance()
        self.field.set_robot_pose(self.odometry.update(self.gyro.get_rotation2d(), left, right))
        telemetry.log("Distance", self.distance())
        telemetry.log("Heading", self.heading())
        telemetry.log("Field", self.field)

    def distance(self) -> float:
        """Return how far the robot has driven, in metres."""
        return (self.left_encoder.get_distance() + self.right_encoder.get_distance()) / 2

    def heading(self) -> float:
        """Return the heading in degrees, counter-clockwise."""
        return self.gyro.get_rotation2d().degrees()

    def go(self, forward: float, turn: float) -> None:
        """Drive for the next 20 ms. Both values are from -1 to 1; a turn to the left is positive."""
        self.drive.arcade_drive(forward, turn, square_inputs=False)

    def stop(self) -> None:
        """Stop both motors."""
        self.drive.stop_motor()

    def arcade(self, forward: Callable[[], float], turn: Callable[[], float]) -> commands2.Command:
        """Return a command that drives with the values of these two functions."""
        return self.run_end(lambda: self.go(forward(), turn()), self.stop)
