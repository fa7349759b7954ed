"""A mecanum drive that keeps its heading while the driver does not turn."""

import wpilib
import wpilib.drive
from wpimath.controller import PIDController
from wpimath.geometry import Rotation2d

POV_HEADINGS = {0: 0.0, 90: 90.0, 180: 180.0, 270: 270.0}  # the diagonals do nothing


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.motors = [wpilib.PWMSparkMax(channel) for channel in range(4)]
        self.motors[2].setInverted(True)
        self.motors[3].setInverted(True)
        self.drive = wpilib.drive.MecanumDrive(*self.motors)
        self.gyro = wpilib.ADXRS450_Gyro()
        self.heading_pid = PIDController(0.02, 0.0, 0.001)
        self.heading_pid.enableContinuousInput(-180, 180)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()
        self.heading: float | None = None

    def keep_heading(self) -> float:
        """Return how hard to turn to stay at the heading."""
        angle = self.gyro.getAngle()
        if self.heading is None:
            self.heading = angle
            self.heading_pid.reset()
        return max(-0.5, min(0.5, self.heading_pid.calculate(angle, self.heading)))

    def autonomousInit(self) -> None:
        self.timer.restart()
        self.heading = None

    def autonomousPeriodic(self) -> None:
        speed = 0.4 if self.timer.get() < 2.0 else 0.0
        self.drive.driveCartesian(speed, 0.0, self.keep_heading(), Rotation2d.fromDegrees(self.gyro.getAngle()))

    def teleopInit(self) -> None:
        self.heading = None

    def teleopPeriodic(self) -> None:
        if self.gamepad.getStartButtonPressed():
            self.gyro.reset()
            self.heading = None
        self.heading = POV_HEADINGS.get(self.gamepad.getPOV(), self.heading)
        turn = self.gamepad.getRightX()
        if abs(turn) > 0.1:
            self.heading = None
        else:
            turn = self.keep_heading()
        self.drive.driveCartesian(
            -self.gamepad.getLeftY(), self.gamepad.getLeftX(), turn, Rotation2d.fromDegrees(self.gyro.getAngle())
        )

    def testPeriodic(self) -> None:
        self.drive.stopMotor()

    def disabledInit(self) -> None:
        self.drive.stopMotor()
        self.heading = None
