"""A robot with mecanum drive, steered as seen from the field: the stick's way is the robot's, wherever it faces."""

import wpilib
import wpilib.drive
from wpimath.geometry import Rotation2d

# What autonomous does: for how many seconds, how fast forward and how fast to the right.
AUTONOMOUS = [
    (2.0, 0.4, 0.0),
    (1.5, 0.0, 0.4),
]


class MyRobot(wpilib.TimedRobot):
    """Your robot. Each method is called by WPILib when its name says so."""

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
        self.drive.setDeadband(0.1)  # sticks never come back to exactly 0

        self.gyro = wpilib.ADXRS450_Gyro()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: show the driver which way the robot faces, in degrees clockwise."""
        wpilib.SmartDashboard.putNumber("Heading", self.gyro.getAngle())

    def autonomousInit(self) -> None:
        """Called once when autonomous starts. Which way the robot faces now is forward from here on."""
        self.gyro.reset()
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: take the step whose time it is."""
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
            self.gyro.reset()  # for when the gyro has drifted: face away from you, and press
        forward = -self.gamepad.getLeftY()
        right = self.gamepad.getLeftX()
        turn = self.gamepad.getRightX()
        if self.gamepad.getLeftBumperButton():
            # As seen from the robot: for the last centimetres.
            self.drive.driveCartesian(0.5 * forward, 0.5 * right, 0.5 * turn)
        else:
            self.drive_on_field(forward, right, turn)

    def drive_on_field(self, forward: float, right: float, turn: float) -> None:
        """Drive as seen from the field: `turn` is clockwise, and all are from -1 to 1."""
        # MecanumDrive counts angles clockwise, as gyros do.
        self.drive.driveCartesian(forward, right, turn, Rotation2d.fromDegrees(self.gyro.getAngle()))

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing jumps later."""
        self.drive.stopMotor()
