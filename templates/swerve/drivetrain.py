"""The four swerve modules together: how fast the robot goes as a whole, and where it is."""

import wpilib
from wpimath.geometry import Pose2d, Rotation2d, Translation2d
from wpimath.kinematics import (
    ChassisSpeeds,
    SwerveDrive4Kinematics,
    SwerveDrive4Odometry,
    SwerveModulePosition,
    SwerveModuleState,
)

from swervemodule import MAX_SPEED, SwerveModule

# From the middle of the robot to each module, in metres: forward, and to the left.
HALF_LENGTH = 0.28
HALF_WIDTH = 0.28
MODULE_PLACES = (
    Translation2d(HALF_LENGTH, HALF_WIDTH),
    Translation2d(HALF_LENGTH, -HALF_WIDTH),
    Translation2d(-HALF_LENGTH, HALF_WIDTH),
    Translation2d(-HALF_LENGTH, -HALF_WIDTH),
)

MAX_TURNING_SPEED = 6.0  # of the whole robot, in rad/s

ALL_STILL = (SwerveModuleState(),) * 4


class Drivetrain:
    """Drives the robot; angles are counter-clockwise, and the field's x is away from the driver."""

    def __init__(self) -> None:
        # Where each is plugged in: drive motor and turning motor (PWM), drive encoder (DIO), angle encoder (analog).
        self.front_left = SwerveModule(0, 1, (0, 1), 0)
        self.front_right = SwerveModule(2, 3, (2, 3), 1)
        self.rear_left = SwerveModule(4, 5, (4, 5), 2)
        self.rear_right = SwerveModule(6, 7, (6, 7), 3)
        self.modules = (self.front_left, self.front_right, self.rear_left, self.rear_right)

        self.gyro = wpilib.ADXRS450_Gyro()
        self.kinematics = SwerveDrive4Kinematics(*MODULE_PLACES)
        self.odometry = SwerveDrive4Odometry(self.kinematics, self.gyro.getRotation2d(), self._positions())

        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Odometry", self.field)

    @property
    def pose(self) -> Pose2d:
        """Where the robot is, by its wheels and its gyro, as seen from where it started."""
        return self.odometry.getPose()

    @property
    def heading(self) -> Rotation2d:
        """Which way the robot faces on the field."""
        return self.pose.rotation()

    def drive_on_field(self, speeds: ChassisSpeeds) -> None:
        """Drive at these speeds as seen from the field."""
        self.drive(ChassisSpeeds.fromFieldRelativeSpeeds(speeds, self.heading))

    def drive(self, speeds: ChassisSpeeds) -> None:
        """Drive at these speeds as seen from the robot."""
        # In 20 ms the robot turns a little, so straight lines would come out bent.
        speeds = ChassisSpeeds.discretize(speeds, 0.02)
        states = self.kinematics.toSwerveModuleStates(speeds)
        # When one wheel would have to be faster than it can, slow all down: the direction stays.
        states = self.kinematics.desaturateWheelSpeeds(states, MAX_SPEED)
        self._set(states)

    def stop(self) -> None:
        """Stop all motors."""
        for module in self.modules:
            module.stop()

    def face_forward(self) -> None:
        """From here on, the way that the robot faces now is away from the driver."""
        here = Pose2d(self.pose.translation(), Rotation2d())
        self.odometry.resetPosition(self.gyro.getRotation2d(), self._positions(), here)

    def update_odometry(self) -> None:
        """Find out where the robot has gone since the last call."""
        self.odometry.update(self.gyro.getRotation2d(), self._positions())
        self.field.setRobotPose(self.pose)

    def _set(self, states: tuple[SwerveModuleState, SwerveModuleState, SwerveModuleState, SwerveModuleState]) -> None:
        for module, state in zip(self.modules, states, strict=True):
            module.set(state)

    def _positions(
        self,
    ) -> tuple[SwerveModulePosition, SwerveModulePosition, SwerveModulePosition, SwerveModulePosition]:
        return (
            self.front_left.position,
            self.front_right.position,
            self.rear_left.position,
            self.rear_right.position,
        )
