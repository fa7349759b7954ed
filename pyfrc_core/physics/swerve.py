"""A swerve drive of any number of modules, whose motors are on CAN motor controllers."""

from __future__ import annotations

import math

from ..wpi import geometry
from .can_motors import Mechanism


class SwerveModule:
    """A wheel that one motor drives and another one turns.

    :param drive: what drives the wheel, forward with a positive output. One turn of it is one turn of the wheel
    :param steer: what turns the wheel. It begins straight ahead, and turns counter-clockwise with a positive output
    :param x: the wheel's place in front of the robot's centre, in metres
    :param y: its place to the left of the robot's centre, in metres
    :param wheel_diameter: in metres
    """

    def __init__(self, drive: Mechanism, steer: Mechanism, x: float, y: float, wheel_diameter: float) -> None:
        self.drive, self.steer = drive, steer
        self.place = geometry.translation(x, y)
        self._circumference = math.pi * wheel_diameter

    def update(self, tm_diff: float) -> geometry.Translation2d:
        """Move both motors for `tm_diff` seconds. Return the wheel's velocity relative to the robot, in m/s."""
        self.drive.update(tm_diff)
        self.steer.update(tm_diff)
        return geometry.polar(self.drive.speed * self._circumference, self.steer.turns * math.tau)


class SwerveDrive:
    """The modules together, which move the robot. Wheels that contradict each other slip."""

    def __init__(self, *modules: SwerveModule) -> None:
        self._modules = modules
        places = [module.place for module in modules]
        self._centre = sum(places, geometry.translation()) / len(places)
        self._arms = [place - self._centre for place in places]

    def update(self, tm_diff: float) -> geometry.ChassisSpeeds:
        """Move all motors for `tm_diff` seconds. Return the robot's speeds, relative to the robot."""
        velocities = [module.update(tm_diff) for module in self._modules]
        # The least squares solution: the mean velocity at the mean place, and the turn around it.
        mean = sum(velocities, geometry.translation()) / len(velocities)
        turn = sum(arm.x * each.y - arm.y * each.x for arm, each in zip(self._arms, velocities, strict=True))
        omega = turn / (sum(arm.norm() ** 2 for arm in self._arms) or 1.0)
        return geometry.chassis_speeds(mean.x + omega * self._centre.y, mean.y - omega * self._centre.x, omega)
