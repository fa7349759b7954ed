"""A field-oriented mecanum drive: the robot moves in the stick's direction, whichever way it faces."""

import telemetry
import tunables
import wpilib
import wpilib_drivers
from wpimath import (
    MecanumDriveKinematics,
    MecanumDriveOdometry,
    MecanumDriveWheelPositions,
    Pose2d,
    Rotation2d,
    Translation2d,
)

# The steps of autonomous: seconds, speed forward, speed to the right.
AUTONOMOUS = [
    (2.0, 0.4, 0.0),
    (1.5, 0.0, 0.4),
]

# Where the robot starts: metres from the corner at the right of the blue drivers, as in sim/config.json.
START = Pose2d(0.91, 4.03, Rotation2d())

# From the centre of the robot to each wheel, in metres: forward, and to the left.
HALF_LENGTH = 0.30
HALF_WIDTH = 0.28

WHEEL_CIRCUMFERENCE = 0.48  # in metres
COUNTS_PER_TURN = 2048


class MyRobot(wpilib.TimedRobot):
    """The robot. WPILib calls each method at the time that its name says."""

    def __init__(self) -> None:
        """Called once when the program starts: create motors, sensors and gamepads here."""
        super().__init__()
        self.front_left = wpilib_drivers.PWMSparkMax(0)
        self.rear_left = wpilib_drivers.PWMSparkMax(1)
        self.front_right = wpilib_drivers.PWMSparkMax(2)
        self.rear_right = wpilib_drivers.PWMSparkMax(3)

        # The motors of the two sides face each other, so one side has to be inverted.
        self.front_right.set_inverted(True)
        self.rear_right.set_inverted(True)
        self.drive = wpilib.MecanumDrive(self.front_left, self.rear_left, self.front_right, self.rear_right)

        # One for each motor, in the same order. Each uses two inputs.
        self.encoders = [wpilib.Encoder(0, 1), wpilib.Encoder(2, 3), wpilib.Encoder(4, 5), wpilib.Encoder(6, 7)]
        for encoder in self.encoders:
            encoder.set_distance_per_pulse(WHEEL_CIRCUMFERENCE / COUNTS_PER_TURN)

        self.gyro = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

        self.chooser = tunables.Selectable[list[tuple[float, float, float]]]()
        self.chooser.add_default("Forward, then right", AUTONOMOUS)
        self.chooser.add("Stay", [])
        tunables.publish("Autonomous", self.chooser)

        # The field on the dashboard, with the robot where its wheels and its gyro say that it is.
        kinematics = MecanumDriveKinematics(
            Translation2d(HALF_LENGTH, HALF_WIDTH),
            Translation2d(HALF_LENGTH, -HALF_WIDTH),
            Translation2d(-HALF_LENGTH, HALF_WIDTH),
            Translation2d(-HALF_LENGTH, -HALF_WIDTH),
        )
        self.odometry = MecanumDriveOdometry(kinematics, self.gyro.get_rotation2d(), self.wheel_positions(), START)
        self.field = wpilib.Field2d()

    def robot_periodic(self) -> None:
        """Called every 20 ms in every mode: show the driver the heading (in degrees, to the left) and the place."""
        heading = self.gyro.get_rotation2d()
        telemetry.log("Heading", heading.degrees())
        self.field.set_robot_pose(self.odometry.update(heading, self.wheel_positions()))
        telemetry.log("Field", self.field)

    def wheel_positions(self) -> MecanumDriveWheelPositions:
        """Return how far each wheel has rolled, in metres."""
        positions = MecanumDriveWheelPositions()
        positions.front_left, positions.rear_left, positions.front_right, positions.rear_right = (
            encoder.get_distance() for encoder in self.encoders
        )
        return positions

    def autonomous_init(self) -> None:
        """Called once when autonomous starts: the robot's current heading becomes forward."""
        self.face_forward()
        self.timer.restart()
        self.steps: list[tuple[float, float, float]] = self.chooser.get_selected() or []

    def autonomous_periodic(self) -> None:
        """Called every 20 ms in autonomous: run the current step."""
        step_ends = 0.0
        for seconds, forward, right in self.steps:
            step_ends += seconds
            if self.timer.get() < step_ends:
                self.drive_on_field(forward, right, 0.0)
                return
        self.drive.stop_motor()

    def teleop_periodic(self) -> None:
        """Called every 20 ms in teleop. Pushing a stick forward gives a negative number."""
        if self.gamepad.get_view_button_pressed():
            self.face_forward()  # if the gyro has drifted: turn the robot away from you, and press
        forward = -self.gamepad.get_left_y()
        right = self.gamepad.get_left_x()
        turn = self.gamepad.get_right_x()
        if self.gamepad.get_left_bumper_button():
            # Relative to the robot, for small corrections.
            self.drive.drive_cartesian(0.5 * forward, 0.5 * right, 0.5 * turn)
        else:
            self.drive_on_field(forward, right, turn)

    def face_forward(self) -> None:
        """Define the robot's current heading as the direction away from the driver."""
        here = Pose2d(self.odometry.get_pose().translation(), Rotation2d())
        self.gyro.reset_yaw()
        self.odometry.reset_position(self.gyro.get_rotation2d(), self.wheel_positions(), here)

    def drive_on_field(self, forward: float, right: float, turn: float) -> None:
        """Drive relative to the field. All values are from -1 to 1; `turn` is clockwise."""
        # MecanumDrive counts angles clockwise, Rotation2d counter-clockwise.
        self.drive.drive_cartesian(forward, right, turn, -self.gyro.get_rotation2d())

    def disabled_init(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drive.stop_motor()

    def disabled_periodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
