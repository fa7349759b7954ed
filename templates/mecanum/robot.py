"""A field-oriented mecanum drive: the robot moves in the stick's direction, whichever way it faces."""

import wpilib
import wpilib.drive
from wpimath.geometry import Pose2d, Rotation2d, Translation2d
from wpimath.kinematics import MecanumDriveKinematics, MecanumDriveOdometry, MecanumDriveWheelPositions

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

        # One for each motor, in the same order. Each uses two inputs.
        self.encoders = [wpilib.Encoder(0, 1), wpilib.Encoder(2, 3), wpilib.Encoder(4, 5), wpilib.Encoder(6, 7)]
        for encoder in self.encoders:
            encoder.setDistancePerPulse(WHEEL_CIRCUMFERENCE / COUNTS_PER_TURN)

        self.gyro = wpilib.ADXRS450_Gyro()
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()

        self.chooser = wpilib.SendableChooser()
        self.chooser.setDefaultOption("Forward, then right", AUTONOMOUS)
        self.chooser.addOption("Stay", [])
        wpilib.SmartDashboard.putData("Autonomous", self.chooser)

        # The field on the dashboard, with the robot where its wheels and its gyro say that it is.
        kinematics = MecanumDriveKinematics(
            Translation2d(HALF_LENGTH, HALF_WIDTH),
            Translation2d(HALF_LENGTH, -HALF_WIDTH),
            Translation2d(-HALF_LENGTH, HALF_WIDTH),
            Translation2d(-HALF_LENGTH, -HALF_WIDTH),
        )
        self.odometry = MecanumDriveOdometry(kinematics, self.gyro.getRotation2d(), self.wheel_positions(), START)
        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Field", self.field)

    def robotPeriodic(self) -> None:
        """Called every 20 ms in every mode: show the driver the heading (in degrees, to the left) and the place."""
        heading = self.gyro.getRotation2d()
        wpilib.SmartDashboard.putNumber("Heading", heading.degrees())
        self.field.setRobotPose(self.odometry.update(heading, self.wheel_positions()))

    def wheel_positions(self) -> MecanumDriveWheelPositions:
        """Return how far each wheel has rolled, in metres."""
        positions = MecanumDriveWheelPositions()
        positions.frontLeft, positions.rearLeft, positions.frontRight, positions.rearRight = (
            encoder.getDistance() for encoder in self.encoders
        )
        return positions

    def autonomousInit(self) -> None:
        """Called once when autonomous starts: the robot's current heading becomes forward."""
        self.face_forward()
        self.timer.restart()
        self.steps: list[tuple[float, float, float]] = self.chooser.getSelected() or []

    def autonomousPeriodic(self) -> None:
        """Called every 20 ms in autonomous: run the current step."""
        step_ends = 0.0
        for seconds, forward, right in self.steps:
            step_ends += seconds
            if self.timer.get() < step_ends:
                self.drive_on_field(forward, right, 0.0)
                return
        self.drive.stopMotor()

    def teleopPeriodic(self) -> None:
        """Called every 20 ms in teleop. Pushing a stick forward gives a negative number."""
        if self.gamepad.getBackButtonPressed():
            self.face_forward()  # if the gyro has drifted: turn the robot away from you, and press
        forward = -self.gamepad.getLeftY()
        right = self.gamepad.getLeftX()
        turn = self.gamepad.getRightX()
        if self.gamepad.getLeftBumperButton():
            # Relative to the robot, for small corrections.
            self.drive.driveCartesian(0.5 * forward, 0.5 * right, 0.5 * turn)
        else:
            self.drive_on_field(forward, right, turn)

    def face_forward(self) -> None:
        """Define the robot's current heading as the direction away from the driver."""
        here = Pose2d(self.odometry.getPose().translation(), Rotation2d())
        self.gyro.reset()
        self.odometry.resetPosition(self.gyro.getRotation2d(), self.wheel_positions(), here)

    def drive_on_field(self, forward: float, right: float, turn: float) -> None:
        """Drive relative to the field. All values are from -1 to 1; `turn` is clockwise."""
        # MecanumDrive counts angles clockwise, Rotation2d counter-clockwise.
        self.drive.driveCartesian(forward, right, turn, -self.gyro.getRotation2d())

    def disabledInit(self) -> None:
        """Called once when the robot is disabled: stop, so that nothing moves suddenly later."""
        self.drive.stopMotor()

    def disabledPeriodic(self) -> None:
        """Called every 20 ms while the robot is disabled."""
