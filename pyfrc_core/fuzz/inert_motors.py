"""Which motor controllers ignore what they receive while the robot is disabled: those on the CAN bus.

WPILib's own controllers are PWM outputs, which keep the value for the moment in which the robot is enabled again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import wpilib

from ..hal import HalData
from .motor_calls import motor_groups


class InertMotors:
    """Recognizes motor controllers that are inert while the robot is disabled, and groups and drives of them.

    :param members: see `MotorCalls`
    """

    def __init__(self, hal_data: HalData, members: Mapping[int, Sequence[Any]]) -> None:
        self._hal_data = hal_data
        self._members = members

    def is_inert(self, motor: object) -> bool:
        """Return whether a motor controller or drive is inert while the robot is disabled.

        A class of the robot's own is: it passes its calls on to another motor controller.
        """
        if isinstance(motor, motor_groups()):
            members = self._members.get(id(motor))
            if members is None:  # created before it could be watched
                return not any(output["initialized"] for output in self._hal_data["pwm"])
            return all(self.is_inert(member) for member in members)
        return not isinstance(motor, wpilib.PWMMotorController)

    def in_group(self, motor: object) -> bool:
        """Return whether a motor belongs to a drive or a group."""
        return any(motor is member for members in self._members.values() for member in members)
