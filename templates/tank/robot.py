"""A robot with tank drive: the left stick drives the left side, the right stick the right side."""

import wpilib
import wpilib.drive
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import DifferentialDriveOdometry

# Where the robot starts: metres from the corner at the right of the blue drivers, as in sim/config.json.
START = Pose2d(3.05, 4.03, Rotation2d())
TRACK_WIDTH = 0.61  # from the left wheels to the right wheels, in metres


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def robotInit(self) -> None:
        """Called once when the program starts: create motors, sensors and joysticks here."""
        # Two motors on each side: the second one follows the first one.
        self.left_motor = wpilib.PWMSparkMax(0)
        self.left_follower = wpilib.PWMSparkMax(1)
        self.left_motor.addFollower(self.left_follower)
        self.right_motor = wpilib.PWMSparkMax(2)
        self.right_follower = wpilib.PWMSparkMax(3)
        self.right_motor.addFollower(self.right_follower)

        # The motors of the two sides face each other, so one side has to be inverted.
        self.right_motor.setInverted(True)
        self.drive = wpilib.drive.DifferentialDrive(self.left_motor, self.right_motor)

        # Each encoder uses two inputs. Here 360 counts are one turn of a 15 cm wheel.
        self.left_encoder = wpilib.Encoder(0, 1)
        self.right_encoder = wpilib.Encoder(2, 3)
        for encoder in (self.left_encoder, self.right_encoder):
            encoder.setDistancePerPulse(0.15 * 3.1416 / 360)

        self.left_stick = wpilib.Joystick(0)
        self.right_stick = wpilib.Joystick(1)
        self.timer = wpilib.Timer()

        # The choices for autonomous, with the seconds that each drives.
        self.chooser = wpilib.SendableChooser()
        self.chooser.setDefaultOption("Drive forward", 2.0)
        self.chooser.addOption("Stay", 0.0)
        wpilib.SmartDashboard.putData("Autonomous", self.chooser)

        # The field on the dashboard, with the robot where its encoders say that it is.
        self.odometry = DifferentialDriveOdometry(Rotation2d(), 0, 0, START)
        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Field", self.field)

    def autonomousInit(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()
        self.drive_seconds: float = self.chooser.getSelected() or 0.0

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: drive forward at half speed, for as long as chosen."""
        if self.timer.get() < self.drive_seconds:
            self.drive.tankDrive(0.5, 0.5, squareInputs=False)
        else:
            self.drive.stopMotor()

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop. Pushing a stick forward gives a negative number."""
        self.drive.tankDrive(-self.left_stick.getY(), -self.right_stick.getY())

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drive.stopMotor()

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: show the driver the distances (in metres) and the place on the field."""
        left, right = self.left_encoder.getDistance(), self.right_encoder.getDistance()
        wpilib.SmartDashboard.putNumber("Left distance", left)
        wpilib.SmartDashboard.putNumber("Right distance", right)
        # The right wheels go further than the left ones when the robot turns left. A gyro measures turns better.
        heading = Rotation2d((right - left) / TRACK_WIDTH)
        self.field.setRobotPose(self.odometry.update(heading, left, right))

    def disabledPeriodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
