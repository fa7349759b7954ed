"""PWM outputs and relays, switched off and back on: see `output_gate`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from wpilib import simulation as sim

from ..fields import INITIALIZED, DeviceField
from ..kinds import BOOL

__all__ = ["Channels"]

#: The pulse that stops a PWM motor controller, in microseconds: within the deadband of all of them. Not 0, as on the
#: robot's wire, since physics that computes with pulses would treat it as full speed backwards.
_NEUTRAL_US = 1500

_PWMS, _RELAYS = 20, 4

#: Restores one output.
Restore = Callable[[], None]
#: Reads and writes one switch.
Switch = tuple[Callable[[], bool], Callable[[bool], None]]


class Channels:
    """The PWM outputs and relays that the robot has created."""

    def __init__(self) -> None:
        self._pwms = [sim.PWMSim(channel) for channel in range(_PWMS)]
        self._relays = [sim.RelaySim(channel) for channel in range(_RELAYS)]
        forward = DeviceField("initialized", "InitializedForward", BOOL)
        reverse = DeviceField("initialized", "InitializedReverse", BOOL)
        #: A slot for each that says whether it exists.
        self.initialized = [
            *(INITIALIZED.slot(pwm) for pwm in self._pwms),
            *(field.slot(relay) for field in (forward, reverse) for relay in self._relays),
        ]
        self._motors: list[Any] = []

    def find(self, created: Iterator[bool]) -> list[Switch]:
        """Find out which exist, and return the switches among them.

        :param created: whether each of `initialized` is true
        """
        self._motors = [pwm for pwm in self._pwms if next(created)]
        switches: list[Switch] = [(relay.getForward, relay.setForward) for relay in self._relays if next(created)]
        return [*switches, *((relay.getReverse, relay.setReverse) for relay in self._relays if next(created))]

    def turn_off(self) -> Iterator[Restore]:
        """Turn off the PWM outputs that are on. Servos keep their position."""
        for motor in self._motors:
            speed = motor.getSpeed()
            if speed and not _drives_servo(motor):
                pulse = motor.getPulseMicrosecond()
                motor.setSpeed(0.0)
                motor.setPulseMicrosecond(_NEUTRAL_US)
                yield partial(restore, motor.getSpeed, motor.setSpeed, 0.0, speed)
                yield partial(restore, motor.getPulseMicrosecond, motor.setPulseMicrosecond, _NEUTRAL_US, pulse)


def _drives_servo(pwm: sim.PWMSim) -> bool:
    """Return whether the pulses are for a servo: 600 to 2400 microseconds, without a deadband in the middle."""
    return abs(600 + 1800 * pwm.getPosition() - pwm.getPulseMicrosecond()) <= 1


def restore(get: Callable[[], Any], put: Callable[[Any], None], off: Any, before: Any) -> None:
    """Restore an output, unless it was written meanwhile."""
    if get() == off:
        put(before)
