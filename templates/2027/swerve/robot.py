"""A swerve drive: each of the four wheels turns in any direction, so the robot can move in any direction."""

import tunables
import wpilib
from wpimath import ChassisVelocities, Pose2d, Rotation2d, SlewRateLimiter

from drivetrain import MAX_TURNING_SPEED, Drivetrain
from swervemodule import MAX_SPEED

# The steps of autonomous: seconds, and speeds relative to the field (m/s forward, m/s to the left,
# rad/s counter-clockwise).
AUTONOMOUS = [
    (2.0, ChassisVelocities(1.0, 0.0, 0.0)),
    (1.0, ChassisVelocities(0.0, 1.0, 0.0)),
    (1.0, ChassisVelocities(0.0, 0.0, 1.5)),
]


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def __init__(self) -> None:
        """Called once when the program starts."""
        super().__init__()
        self.drivetrain = Drivetrain()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

        self.chooser = tunables.Selectable[list[tuple[float, ChassisVelocities]]]()
        self.chooser.add_default("Forward, left, turn", AUTONOMOUS)
        self.chooser.add("Stay", [])
        tunables.publish("Autonomous", self.chooser)

        # From zero to full speed in a third of a second, so that the wheels do not slip.
        self.forward_limit = SlewRateLimiter(3 * MAX_SPEED)
        self.left_limit = SlewRateLimiter(3 * MAX_SPEED)

    def robot_periodic(self) -> None:
        """Called every 20 ms in every mode: update the robot's pose."""
        self.drivetrain.update_odometry()

    def autonomous_init(self) -> None:
        """Called once when autonomous starts."""
        self.timer.restart()
        self.steps: list[tuple[float, ChassisVelocities]] = self.chooser.get_selected() or []

    def autonomous_periodic(self) -> None:
        """Called every 20 ms in autonomous: run the current step."""
        step_ends = 0.0
        for seconds, speeds in self.steps:
            step_ends += seconds
            if self.timer.get() < step_ends:
                self.drivetrain.drive_on_field(speeds)
                return
        self.drivetrain.stop()

    def teleop_periodic(self) -> None:
        """Called every 20 ms in teleop. Sticks are negative forward and to the left, speeds are positive there."""
        if self.gamepad.get_view_button_pressed():
            self.drivetrain.face_forward()
        forward = -self.gamepad.get_left_y() * MAX_SPEED
        left = -self.gamepad.get_left_x() * MAX_SPEED
        turn = -self.gamepad.get_right_x() * MAX_TURNING_SPEED
        speeds = ChassisVelocities(self.forward_limit.calculate(forward), self.left_limit.calculate(left), turn)
        self.drivetrain.drive_on_field(speeds)

    def disabled_periodic(self) -> None:
        """Called every 20 ms while the robot is disabled: show the path of the chosen autonomous, from here."""
        path = [self.drivetrain.pose]
        for seconds, speeds in self.chooser.get_selected() or []:
            place = path[-1]
            turn = Rotation2d(speeds.omega * seconds)
            x, y = place.x + speeds.vx * seconds, place.y + speeds.vy * seconds
            path.append(Pose2d(x, y, place.rotation() + turn))
        self.drivetrain.show_path(path)

    def disabled_init(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drivetrain.stop()
        self.forward_limit.reset(0)
        self.left_limit.reset(0)
