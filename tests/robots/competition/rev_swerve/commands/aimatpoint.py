"""Drive with the sticks while the robot itself faces a point on the field."""

import math
from collections.abc import Callable

from wpimath.controller import ProfiledPIDController
from wpimath.geometry import Translation2d
from wpimath.trajectory import TrapezoidProfile

from commands.teleopdrive import TeleopDrive
from constants import Drive
from subsystems.drivetrain import Drivetrain


class AimAtPoint(TeleopDrive):
    """Turn towards a point; the sticks move the robot."""

    def __init__(
        self,
        drivetrain: Drivetrain,
        forward: Callable[[], float],
        left: Callable[[], float],
        point: Callable[[], Translation2d],
    ) -> None:
        super().__init__(drivetrain, forward, left, lambda: 0.0)
        self.point = point
        self.controller = ProfiledPIDController(
            Drive.AIM_KP, 0, 0.1, TrapezoidProfile.Constraints(Drive.MAX_ROTATION, 4 * math.pi)
        )
        self.controller.enableContinuousInput(-math.pi, math.pi)

    def initialize(self) -> None:
        """Begin with the current heading."""
        super().initialize()
        self.controller.reset(self.drivetrain.pose().rotation().radians())

    def direction(self) -> float:
        """Return the direction of the point from the robot, in radians."""
        return (self.point() - self.drivetrain.pose().translation()).angle().radians()

    def error(self) -> float:
        """Return how far the robot faces past the point, in radians."""
        return math.remainder(self.drivetrain.pose().rotation().radians() - self.direction(), math.tau)

    def rotation(self) -> float:
        """Return how fast to turn, in radians per second."""
        feedback = self.controller.calculate(self.drivetrain.pose().rotation().radians(), self.direction())
        return feedback + self.controller.getSetpoint().velocity
