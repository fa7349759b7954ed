"""A robot with swerve drive: each of its four wheels can be turned to any direction, and so the robot goes anywhere."""

import wpilib
from wpimath import applyDeadband
from wpimath.filter import SlewRateLimiter
from wpimath.kinematics import ChassisSpeeds

from drivetrain import MAX_TURNING_SPEED, Drivetrain
from swervemodule import MAX_SPEED

# What autonomous does: for how many seconds, at which speeds as seen from the field (m/s forward, m/s to the left,
# rad/s counter-clockwise).
AUTONOMOUS = [
    (2.0, ChassisSpeeds(1.0, 0.0, 0.0)),
    (1.0, ChassisSpeeds(0.0, 1.0, 0.0)),
    (1.0, ChassisSpeeds(0.0, 0.0, 1.5)),
]


class MyRobot(wpilib.TimedRobot):
    """Your robot. Each method is called by WPILib when its name says so."""

    def robotInit(self) -> None:
        """Called once when the program starts."""
        self.drivetrain = Drivetrain()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

        # From standing to full speed in a third of a second, so that the wheels do not slip.
        self.forward_limit = SlewRateLimiter(3 * MAX_SPEED)
        self.left_limit = SlewRateLimiter(3 * MAX_SPEED)

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: keep count of where the robot is."""
        self.drivetrain.update_odometry()

    def autonomousInit(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: take the step whose time it is."""
        step_ends = 0.0
        for seconds, speeds in AUTONOMOUS:
            step_ends += seconds
            if self.timer.get() < step_ends:
                self.drivetrain.drive_on_field(speeds)
                return
        self.drivetrain.stop()

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop. Sticks are negative forward and to the left, speeds are positive there."""
        if self.gamepad.getBackButtonPressed():
            self.drivetrain.face_forward()
        forward = -applyDeadband(self.gamepad.getLeftY(), 0.1) * MAX_SPEED
        left = -applyDeadband(self.gamepad.getLeftX(), 0.1) * MAX_SPEED
        turn = -applyDeadband(self.gamepad.getRightX(), 0.1) * MAX_TURNING_SPEED
        speeds = ChassisSpeeds(self.forward_limit.calculate(forward), self.left_limit.calculate(left), turn)
        self.drivetrain.drive_on_field(speeds)

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing jumps later."""
        self.drivetrain.stop()
        self.forward_limit.reset(0)
        self.left_limit.reset(0)
