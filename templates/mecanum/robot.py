"""A field-oriented mecanum drive: the robot moves in the stick's direction, whichever way it faces."""

import wpilib
import wpilib.drive
from wpimath.geometry import Rotation2d

# The steps of autonomous: seconds, speed forward, speed to the right.
AUTONOMOUS = [
    (2.0, 0.4, 0.0),
    (1.5, 0.0, 0.4),
]


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def robotInit(self) -> None:
        """Called once when the program starts: create motors, sensors and gamepads here."""
        self.front_left = wpilib.PWMSparkMax(0)
        self.rear_left = wpilib.PWMSparkMax(1)
        self.front_right = wpilib.PWMSparkMax(2)
        self.rear_right = wpilib.PWMSparkMax(3)

        # The motors of the two sides face each other, so one side has to be inverted.
        self.front_right.setInverted(True)
        self.rear_right.setInverted(True)
        self.drive = wpilib.drive.MecanumDrive(self.front_left, self.rear_left, self.front_right, self.rear_right)
        self.drive.setDeadband(0.1)  # sticks never return to exactly 0

        self.gyro = wpilib.ADXRS450_Gyro()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: show the driver the robot's heading, in degrees clockwise."""
        wpilib.SmartDashboard.putNumber("Heading", self.gyro.getAngle())

    def autonomousInit(self) -> None:
        """Called once when autonomous starts: the robot's current heading becomes forward."""
        self.gyro.reset()
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: run the current step."""
        step_ends = 0.0
        for seconds, forward, right in AUTONOMOUS:
            step_ends += seconds
            if self.timer.get() < step_ends:
                self.drive_on_field(forward, right, 0.0)
                return
        self.drive.stopMotor()

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop. Pushing a stick forward gives a negative number."""
        if self.gamepad.getBackButtonPressed():
            self.gyro.reset()  # if the gyro has drifted: turn the robot away from you, and press
        forward = -self.gamepad.getLeftY()
        right = self.gamepad.getLeftX()
        turn = self.gamepad.getRightX()
        if self.gamepad.getLeftBumperButton():
            # Relative to the robot, for small corrections.
            self.drive.driveCartesian(0.5 * forward, 0.5 * right, 0.5 * turn)
        else:
            self.drive_on_field(forward, right, turn)

    def drive_on_field(self, forward: float, right: float, turn: float) -> None:
        """Drive relative to the field. All values are from -1 to 1; `turn` is clockwise."""
        # MecanumDrive counts angles clockwise, as gyros do.
        self.drive.driveCartesian(forward, right, turn, Rotation2d.fromDegrees(self.gyro.getAngle()))

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drive.stopMotor()
