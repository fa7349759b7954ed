"""Watch the calls with which robot code sets its motors."""

from __future__ import annotations

import weakref
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import starmap
from typing import Any

from ...hal import HalData
from ...patch_table import Patch, patched
from ...wpi import motor_controllers


@contextmanager
def watch_motor_calls() -> Iterator[motor_controllers.MotorCalls]:
    """Watch until the context ends; the robot's modules must be imported."""
    calls = motor_controllers.MotorCalls()
    with patched(starmap(Patch, motor_controllers.replacements(calls))):
        yield calls


class InertMotors:
    """Recognizes motor controllers that ignore what they receive while the robot is disabled: those on the CAN bus, and
    groups and drives of them. WPILib's own are PWM outputs, which keep the value for the moment of enabling.

    :param members: see `motor_controllers.MotorCalls`
    """

    def __init__(self, hal_data: HalData, members: Mapping[int, Sequence[weakref.ref[Any]]]) -> None:
        self._hal_data = hal_data
        self._members = members

    def is_inert(self, motor: object) -> bool:
        """Return whether a motor controller or drive is inert while the robot is disabled.

        A class of the robot's own is: it passes its calls on to another motor controller.
        """
        if motor_controllers.is_group(motor):
            members = self._members.get(id(motor))
            if members is None:  # created before it could be watched
                return not any(output["initialized"] for output in self._hal_data["pwm"])
            return all(self.is_inert(member()) for member in members)
        return not motor_controllers.is_pwm(motor)

    def motors_of(self, motor: object) -> list[object]:
        """Return the motors of a drive or a group, as far as they are known; of a motor controller, itself."""
        if not motor_controllers.is_group(motor):
            return [motor]
        return [each for member in self._members.get(id(motor), ()) for each in self.motors_of(member())]

    def in_group(self, motor: object) -> bool:
        """Return whether a motor belongs to a drive or a group."""
        return any(motor is member() for members in self._members.values() for member in members)
