"""A robot with tank drive: the left stick drives the left side, the right stick the right side."""

import wpilib
import wpilib.drive


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

    def autonomousInit(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()
        self.left_encoder.reset()
        self.right_encoder.reset()

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: drive forward for two seconds, at half speed."""
        if self.timer.get() < 2.0:
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
        """Called every 20 ms in every mode: show the distances (in metres) to the driver."""
        wpilib.SmartDashboard.putNumber("Left distance", self.left_encoder.getDistance())
        wpilib.SmartDashboard.putNumber("Right distance", self.right_encoder.getDistance())

    def disabledPeriodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
