"""The drivers drive."""

from collections.abc import Callable

import commands2
from wpimath import applyDeadband
from wpimath.filter import SlewRateLimiter

from constants import Controllers, Drive
from subsystems.drivetrain import Drivetrain


def shape(value: float) -> float:
    """Return what a stick means: nothing near its centre, and finer control at low speeds."""
    value = applyDeadband(value, Controllers.DEADBAND)
    return value * abs(value)


class TeleopDrive(commands2.Command):
    """Drive relative to the field, with limited acceleration."""

    def __init__(
        self,
        drivetrain: Drivetrain,
        forward: Callable[[], float],
        left: Callable[[], float],
        turn: Callable[[], float],
    ) -> None:
        super().__init__()
        self.drivetrain = drivetrain
        self.forward, self.left, self.turn = forward, left, turn
        self.x_limiter = SlewRateLimiter(Drive.MAX_ACCELERATION)
        self.y_limiter = SlewRateLimiter(Drive.MAX_ACCELERATION)
        self.addRequirements(drivetrain)

    def initialize(self) -> None:
        """Begin at rest."""
        self.x_limiter.reset(0)
        self.y_limiter.reset(0)

    def rotation(self) -> float:
        """Return how fast to turn, in radians per second."""
        return shape(self.turn()) * Drive.MAX_ROTATION

    def execute(self) -> None:
        """Pass the sticks on."""
        scale = Drive.SLOW_FACTOR if self.drivetrain.slow else 1.0
        vx = self.x_limiter.calculate(shape(self.forward()) * Drive.MAX_SPEED * scale)
        vy = self.y_limiter.calculate(shape(self.left()) * Drive.MAX_SPEED * scale)
        self.drivetrain.drive_field_relative(vx, vy, self.rotation() * scale)

    def end(self, interrupted: bool) -> None:
        """Stop."""
        self.drivetrain.stop()
