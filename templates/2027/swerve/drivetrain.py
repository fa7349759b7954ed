"""The four swerve modules together: the robot's speed and its pose."""

import ntcore
import telemetry
import wpilib
from wpimath import (
    ChassisVelocities,
    Pose2d,
    Rotation2d,
    SwerveDrive4Kinematics,
    SwerveDrive4Odometry,
    SwerveModulePosition,
    SwerveModuleVelocity,
    Translation2d,
)

from swervemodule import MAX_SPEED, SwerveModule

# From the centre of the robot to each module, in metres: forward, and to the left.
HALF_LENGTH = 0.28
HALF_WIDTH = 0.28
MODULE_PLACES = (
    Translation2d(HALF_LENGTH, HALF_WIDTH),
    Translation2d(HALF_LENGTH, -HALF_WIDTH),
    Translation2d(-HALF_LENGTH, HALF_WIDTH),
    Translation2d(-HALF_LENGTH, -HALF_WIDTH),
)

# Where the robot starts: metres from the corner at the right of the blue drivers, as in sim/config.json.
START = Pose2d(3.05, 4.03, Rotation2d())

MAX_TURNING_SPEED = 6.0  # of the whole robot, in rad/s


class Drivetrain:
    """The drivetrain. Angles are counter-clockwise, and the field's x axis points away from the driver."""

    def __init__(self) -> None:
        # The channels of each module: drive motor and turning motor (PWM), drive encoder (DIO), angle encoder (analog).
        self.front_left = SwerveModule(0, 1, (0, 1), 0)
        self.front_right = SwerveModule(2, 3, (2, 3), 1)
        self.rear_left = SwerveModule(4, 5, (4, 5), 2)
        self.rear_right = SwerveModule(6, 7, (6, 7), 3)
        self.modules = (self.front_left, self.front_right, self.rear_left, self.rear_right)

        self.gyro = wpilib.OnboardIMU(wpilib.OnboardIMU.MountOrientation.FLAT)
        self.kinematics = SwerveDrive4Kinematics(*MODULE_PLACES)
        self.odometry = SwerveDrive4Odometry(self.kinematics, self.gyro.get_rotation2d(), self._positions(), START)

        # The field on the dashboard, and the modules' states, which dashboards draw as arrows.
        self.field = wpilib.Field2d()
        table = ntcore.NetworkTableInstance.get_default()
        self.measured = table.get_struct_array_topic("/SwerveStates/Measured", SwerveModuleVelocity).publish()
        self.target = table.get_struct_array_topic("/SwerveStates/Target", SwerveModuleVelocity).publish()

    @property
    def pose(self) -> Pose2d:
        """Return the robot's pose on the field, from its wheels and its gyro."""
        return self.odometry.get_pose()

    @property
    def heading(self) -> Rotation2d:
        """Return the robot's heading on the field."""
        return self.pose.rotation()

    def drive_on_field(self, speeds: ChassisVelocities) -> None:
        """Drive at these speeds relative to the field."""
        self.drive(speeds.to_robot_relative(self.heading))

    def drive(self, speeds: ChassisVelocities) -> None:
        """Drive at these speeds relative to the robot."""
        # The robot turns a little within 20 ms, which would bend straight lines.
        speeds = speeds.discretize(0.02)
        states = self.kinematics.to_swerve_module_velocities(speeds)
        # If one wheel would exceed its maximum speed, slow all of them down, so that the direction stays.
        states = self.kinematics.desaturate_wheel_velocities(states, MAX_SPEED)
        for module, state in zip(self.modules, states, strict=True):
            module.set(state)
        self.target.set(list(states))

    def stop(self) -> None:
        """Stop all motors."""
        for module in self.modules:
            module.stop()
        self.target.set([SwerveModuleVelocity(0, module.angle) for module in self.modules])

    def face_forward(self) -> None:
        """Define the robot's current heading as the direction away from the driver."""
        here = Pose2d(self.pose.translation(), Rotation2d())
        self.odometry.reset_position(self.gyro.get_rotation2d(), self._positions(), here)

    def update_odometry(self) -> None:
        """Update the pose with the movement since the last call, and show it."""
        self.odometry.update(self.gyro.get_rotation2d(), self._positions())
        self.field.set_robot_pose(self.pose)
        telemetry.log("Field", self.field)
        self.measured.set([module.state for module in self.modules])

    def show_path(self, path: list[Pose2d]) -> None:
        """Show on the field where the robot is to go."""
        self.field.get_object("Path").set_poses(path)

    def _positions(
        self,
    ) -> tuple[SwerveModulePosition, SwerveModulePosition, SwerveModulePosition, SwerveModulePosition]:
        return (
            self.front_left.position,
            self.front_right.position,
            self.rear_left.position,
            self.rear_right.position,
        )
