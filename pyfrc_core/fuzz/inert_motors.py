"""Which motor controllers ignore what they receive while the robot is disabled: those on the CAN bus.

WPILib's own controllers are PWM outputs, which keep the value for the moment in which the robot is enabled again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import wpilib
from wpilib.interfaces import MotorController

from ..hal import HalData
from ..runtime.patch_table import Patch, patched
from .motor_calls import DRIVES

_GROUPS = (wpilib.MotorControllerGroup, *(drive for drive, _ in DRIVES))


class InertMotors:
    """Recognizes motor controllers that are inert while the robot is disabled, and groups and drives of them."""

    def __init__(self, hal_data: HalData) -> None:
        self._hal_data = hal_data
        #: The motors of each group and drive, by its id: objects of WPILib's are not hashable in all versions.
        self._members: dict[int, list[Any]] = {}

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Note the motors of each group and drive that is created, until the context ends."""
        with patched(Patch(owner, "__init__", self._init(owner.__init__)) for owner in _GROUPS):
            yield

    def is_inert(self, motor: object) -> bool:
        """Return whether a motor controller or drive is inert while the robot is disabled.

        A class of the robot's own is: it passes its calls on to another motor controller.
        """
        if isinstance(motor, _GROUPS):
            members = self._members.get(id(motor))
            if members is None:  # created before it could be watched
                return not any(output["initialized"] for output in self._hal_data["pwm"])
            return all(self.is_inert(member) for member in members)
        return not isinstance(motor, wpilib.PWMMotorController)

    def in_group(self, motor: object) -> bool:
        """Return whether a motor belongs to a drive or a group."""
        return any(motor is member for members in self._members.values() for member in members)

    def _init(self, real: Callable[..., None]) -> Callable[..., None]:
        members = self._members

        # The name matters to WPILib's bindings, see `motor_calls`.
        def __init__(self: object, *args: object, **kwargs: object) -> None:
            real(self, *args, **kwargs)
            members[id(self)] = [each for each in (*args, *kwargs.values()) if isinstance(each, MotorController)]

        return __init__
