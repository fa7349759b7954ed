"""A robot with tank drive: the left stick drives the left side, the right stick the right side."""

import telemetry
import tunables
import wpilib
import wpilib_drivers
from wpimath import DifferentialDriveOdometry, Pose2d, Rotation2d

# Where the robot starts: metres from the corner at the right of the blue drivers, as in sim/config.json.
START = Pose2d(3.05, 4.03, Rotation2d())
TRACK_WIDTH = 0.61  # from the left wheels to the right wheels, in metres


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def __init__(self) -> None:
        """Called once when the program starts: create motors, sensors and joysticks here."""
        super().__init__()
        # Two motors on each side: the second one follows the first one.
        self.left_motor = wpilib_drivers.PWMSparkMax(0)
        self.left_follower = wpilib_drivers.PWMSparkMax(1)
        self.left_motor.add_follower(self.left_follower)
        self.right_motor = wpilib_drivers.PWMSparkMax(2)
        self.right_follower = wpilib_drivers.PWMSparkMax(3)
        self.right_motor.add_follower(self.right_follower)

        # The motors of the two sides face each other, so one side has to be inverted.
        self.right_motor.set_inverted(True)
        self.drive = wpilib.DifferentialDrive(self.left_motor, self.right_motor)

        # Each encoder uses two inputs. Here 360 counts are one turn of a 15 cm wheel.
        self.left_encoder = wpilib.Encoder(0, 1)
        self.right_encoder = wpilib.Encoder(2, 3)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.set_distance_per_pulse(0.15 * 3.1416 / 360)

        self.left_stick = wpilib.Joystick(0)
        self.right_stick = wpilib.Joystick(1)
        self.timer = wpilib.Timer()

        # The choices for autonomous, with the seconds that each drives.
        self.chooser = tunables.Selectable[float]()
        self.chooser.add_default("Drive forward", 2.0)
        self.chooser.add("Stay", 0.0)
        tunables.publish("Autonomous", self.chooser)

        # The field on the dashboard, with the robot where its encoders say that it is.
        self.odometry = DifferentialDriveOdometry(Rotation2d(), 0, 0, START)
        self.field = wpilib.Field2d()

    def autonomous_init(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()
        self.drive_seconds: float = self.chooser.get_selected() or 0.0

    def autonomous_periodic(self) -> None:
        """Called every 20 ms in autonomous: drive forward at half speed, for as long as chosen."""
        if self.timer.get() < self.drive_seconds:
            self.drive.tank_drive(0.5, 0.5, square_inputs=False)
        else:
            self.drive.stop_motor()

    def teleop_periodic(self) -> None:
        """Called every 20 ms in teleop. Pushing a stick forward gives a negative number."""
        self.drive.tank_drive(-self.left_stick.get_y(), -self.right_stick.get_y())

    def disabled_init(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drive.stop_motor()

    def robot_periodic(self) -> None:
        """Called every 20 ms in every mode: show the driver the distances (in metres) and the place on the field."""
        left, right = self.left_encoder.get_distance(), self.right_encoder.get_distance()
        telemetry.log("Left distance", left)
        telemetry.log("Right distance", right)
        # The right wheels go further than the left ones when the robot turns left. A gyro measures turns better.
        heading = Rotation2d((right - left) / TRACK_WIDTH)
        self.field.set_robot_pose(self.odometry.update(heading, left, right))
        telemetry.log("Field", self.field)

    def disabled_periodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
