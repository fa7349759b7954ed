"""A swerve drive: each of the four wheels turns in any direction, so the robot can move in any direction."""

import wpilib
from wpimath import applyDeadband
from wpimath.filter import SlewRateLimiter
from wpimath.geometry import Pose2d, Rotation2d
from wpimath.kinematics import ChassisSpeeds

from drivetrain import MAX_TURNING_SPEED, Drivetrain
from swervemodule import MAX_SPEED

# The steps of autonomous: seconds, and speeds relative to the field (m/s forward, m/s to the left,
# rad/s counter-clockwise).
AUTONOMOUS = [
    (2.0, ChassisSpeeds(1.0, 0.0, 0.0)),
    (1.0, ChassisSpeeds(0.0, 1.0, 0.0)),
    (1.0, ChassisSpeeds(0.0, 0.0, 1.5)),
]


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def robotInit(self) -> None:
        """Called once when the program starts."""
        self.drivetrain = Drivetrain()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

        self.chooser = wpilib.SendableChooser()
        self.chooser.setDefaultOption("Forward, left, turn", AUTONOMOUS)
        self.chooser.addOption("Stay", [])
        wpilib.SmartDashboard.putData("Autonomous", self.chooser)

        # From zero to full speed in a third of a second, so that the wheels do not slip.
        self.forward_limit = SlewRateLimiter(3 * MAX_SPEED)
        self.left_limit = SlewRateLimiter(3 * MAX_SPEED)

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: update the robot's pose."""
        self.drivetrain.update_odometry()

    def autonomousInit(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()
        self.steps: list[tuple[float, ChassisSpeeds]] = self.chooser.getSelected() or []

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: run the current step."""
        step_ends = 0.0
        for seconds, speeds in self.steps:
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

    def disabledPeriodic(self) -> None:
        """Called every 20 ms while the robot is disabled: show the path of the chosen autonomous, from here."""
        path = [self.drivetrain.pose]
        for seconds, speeds in self.chooser.getSelected() or []:
            place = path[-1]
            turn = Rotation2d(speeds.omega * seconds)
            x, y = place.X() + speeds.vx * seconds, place.Y() + speeds.vy * seconds
            path.append(Pose2d(x, y, place.rotation() + turn))
        self.drivetrain.show_path(path)

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drivetrain.stop()
        self.forward_limit.reset(0)
        self.left_limit.reset(0)
