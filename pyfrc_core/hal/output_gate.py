"""Turn outputs off as the hardware of a disabled robot does, whatever the robot's code sets.

On a robot the roboRIO, pneumatics modules and CAN motor controllers turn their outputs off while it is disabled.
WPILib's simulated HAL does not: an output reads as the code set it. `OutputGate` turns outputs off while physics runs,
and then restores the code's values: tests, recordings and the robot itself see those, and they take effect when the
robot is enabled.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from wpilib import simulation as sim

from ..wpi import station
from .can_outputs import CanOutputs
from .created_devices import CreatedDevices
from .fields import INITIALIZED, DeviceField
from .kinds import BOOL
from .modules import MODULES
from .motor_getters import MotorGetters

#: The pulse that stops a PWM motor controller, in microseconds: within the deadband of all of them. Not 0, as on the
#: robot's wire, since physics that computes with pulses would treat it as full speed backwards.
_NEUTRAL_US = 1500

_PWMS, _RELAYS = 20, 4
_PCM_CHANNELS, _HUB_CHANNELS = 8, 16

#: Restores one output.
Restore = Callable[[], None]


class OutputGate:
    """Turns off the outputs of a robot that is not enabled, while its physics runs."""

    def __init__(self) -> None:
        self._channels = _Channels()
        self._can = CanOutputs()
        self._getters = MotorGetters()
        self._closed = False

    @contextmanager
    def closed_while_disabled(self) -> Iterator[None]:
        """Keep outputs off until the context ends, if the robot is disabled, e-stopped or without a driver station.

        These are PWM motor controllers, relays, solenoids and CAN motor controllers. Servos keep their position. An
        output that is written in the meantime keeps the new value.
        """
        __tracebackhide__ = True
        if self._closed or station.is_enabled():
            yield
            return
        self._closed = True
        restores = [*self._channels.turn_off(), *self._can.turn_off(), *self._getters.turn_off()]
        try:
            yield
        finally:
            self._closed = False
            for restore in restores:
                restore()


class _Channels:
    """The PWM outputs, relays and solenoids that the robot has created."""

    def __init__(self) -> None:
        self._pwms = [sim.PWMSim(channel) for channel in range(_PWMS)]
        self._relays = [sim.RelaySim(channel) for channel in range(_RELAYS)]
        self._pneumatics: list[tuple[Any, int]] = [
            *((sim.CTREPCMSim(number), _PCM_CHANNELS) for number in range(MODULES)),
            *((sim.REVPHSim(number), _HUB_CHANNELS) for number in range(MODULES)),
        ]
        forward = DeviceField("initialized", "InitializedForward", BOOL)
        reverse = DeviceField("initialized", "InitializedReverse", BOOL)
        self._devices = CreatedDevices(
            [
                *(INITIALIZED.slot(pwm) for pwm in self._pwms),
                *(field.slot(relay) for field in (forward, reverse) for relay in self._relays),
                *(INITIALIZED.slot(module) for module, _ in self._pneumatics),
            ]
        )
        self._created: list[bool] | None = None
        self._motors: list[Any] = []
        self._switches: list[tuple[Callable[[], bool], Callable[[bool], None]]] = []

    def turn_off(self) -> Iterator[Restore]:
        """Turn off the outputs that are on."""
        created = self._devices.created()
        if created is not self._created:
            self._created = created
            self._find(created)
        for motor in self._motors:
            speed = motor.getSpeed()
            if speed and not _drives_servo(motor):
                pulse = motor.getPulseMicrosecond()
                motor.setSpeed(0.0)
                motor.setPulseMicrosecond(_NEUTRAL_US)
                yield partial(_restore, motor.getSpeed, motor.setSpeed, 0.0, speed)
                yield partial(_restore, motor.getPulseMicrosecond, motor.setPulseMicrosecond, _NEUTRAL_US, pulse)
        for get, put in self._switches:
            if get():
                put(False)
                yield partial(_restore, get, put, False, True)

    def _find(self, created: list[bool]) -> None:
        is_created = iter(created)
        self._motors = [pwm for pwm in self._pwms if next(is_created)]
        self._switches = [(relay.getForward, relay.setForward) for relay in self._relays if next(is_created)]
        self._switches += [(relay.getReverse, relay.setReverse) for relay in self._relays if next(is_created)]
        for module, channels in self._pneumatics:
            if next(is_created):
                for channel in range(channels):
                    get, put = partial(module.getSolenoidOutput, channel), partial(module.setSolenoidOutput, channel)
                    self._switches.append((get, put))


def _drives_servo(pwm: sim.PWMSim) -> bool:
    """Return whether the pulses are for a servo: 600 to 2400 microseconds, without a deadband in the middle."""
    return abs(600 + 1800 * pwm.getPosition() - pwm.getPulseMicrosecond()) <= 1


def _restore(get: Callable[[], Any], put: Callable[[Any], None], off: Any, before: Any) -> None:
    if get() == off:
        put(before)
