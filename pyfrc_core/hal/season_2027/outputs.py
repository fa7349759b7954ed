"""PWM outputs, switched off and back on: see `output_gate`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from ..fields import INITIALIZED
from .pwm import MotorPwmSim

__all__ = ["Channels"]

#: The pulse that stops a PWM motor controller, in microseconds: within the deadband of all of them.
_NEUTRAL_US = 1500

_PWMS = 20

#: Restores one output.
Restore = Callable[[], None]
#: Reads and writes one switch.
Switch = tuple[Callable[[], bool], Callable[[bool], None]]


class Channels:
    """The PWM outputs that the robot has created."""

    def __init__(self) -> None:
        self._pwms = [MotorPwmSim(channel) for channel in range(_PWMS)]
        #: A slot for each that says whether it exists.
        self.initialized = [INITIALIZED.slot(pwm) for pwm in self._pwms]
        self._motors: list[MotorPwmSim] = []

    def find(self, created: Iterator[bool]) -> list[Switch]:
        """Find out which exist, and return the switches among them.

        :param created: whether each of `initialized` is true
        """
        self._motors = [pwm for pwm in self._pwms if next(created)]
        return []

    def turn_off(self) -> Iterator[Restore]:
        """Turn off the motor controllers that are on. Other PWM outputs, such as servos', keep their pulse."""
        for motor in self._motors:
            throttle = motor.get_throttle()
            if throttle:
                pulse = motor.get_pulse_microsecond()
                motor.set_throttle(0.0)
                motor.set_pulse_microsecond(_NEUTRAL_US)
                yield partial(restore, motor.get_throttle, motor.set_throttle, 0.0, throttle)
                yield partial(restore, motor.get_pulse_microsecond, motor.set_pulse_microsecond, _NEUTRAL_US, pulse)


def restore(get: Callable[[], Any], put: Callable[[Any], None], off: Any, before: Any) -> None:
    """Restore an output, unless it was written meanwhile."""
    if get() == off:
        put(before)
