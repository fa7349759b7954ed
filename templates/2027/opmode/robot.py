"""The robot's devices, and what it does at all times. What it does in a match is in opmodes/."""

import telemetry
import wpilib
import wpilib_drivers
from wpimath import DifferentialDriveOdometry, Pose2d, Rotation2d

# Where the robot starts: metres from the corner at the right of the blue drivers, as in sim/config.json.
START = Pose2d(3.05, 4.03, Rotation2d())

WHEEL_CIRCUMFERENCE = 0.48  # in metres
COUNTS_PER_TURN = 2048


class MyRobot(wpilib.OpModeRobot):
    """The robot. WPILib finds its opmodes, and makes the one that is selected on the driver station."""

    def __init__(self) -> None:
        """Called once when the program starts: create motors, sensors and gamepads here."""
        super().__init__()
        self.left_motor = wpilib_drivers.PWMSparkMax(0)
        self.right_motor = wpilib_drivers.PWMSparkMax(1)
        self.right_motor.set_inverted(True)  # the motors face each other
        self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)

        # Each encoder uses two inputs. With the motors, all six ports of the controller are in use.
        self.left_encoder = wpilib.Encoder(2, 3)
        self.right_encoder = wpilib.Encoder(4, 5)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.set_distance_per_pulse(WHEEL_CIRCUMFERENCE / COUNTS_PER_TURN)
        self.imu = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)  # the gyro in the controller

        self.gamepad = wpilib.Gamepad(0)

        # The field on the dashboard, with the robot where its wheels and its gyro say that it is.
        self.odometry = DifferentialDriveOdometry(self.imu.get_rotation2d(), 0, 0, START)
        self.field = wpilib.Field2d()

    def robot_periodic(self) -> None:
        """Called every 20 ms, whichever opmode is selected: show the driver the distance and the place."""
        left, right = self.left_encoder.get_distance(), self.right_encoder.get_distance()
        self.field.set_robot_pose(self.odometry.update(self.imu.get_rotation2d(), left, right))
        telemetry.log("Field", self.field)
        telemetry.log("Distance", self.distance())

    def distance(self) -> float:
        """Return how far the robot has driven, in metres."""
        return (self.left_encoder.get_distance() + self.right_encoder.get_distance()) / 2

    def heading(self) -> float:
        """Return the heading in degrees, counter-clockwise."""
        return self.imu.get_rotation2d().degrees()
