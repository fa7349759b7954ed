"""Turn outputs off as the hardware of a disabled robot does, whatever the robot's code sets.

On a robot the roboRIO, pneumatics modules and CAN motor controllers turn their outputs off while it is disabled.
WPILib's simulated HAL does not: an output reads as the code set it. `OutputGate` turns outputs off while physics runs,
and then restores the code's values: tests, recordings and the robot itself see those, and they take effect when the
robot is enabled.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from ..wpi import motor_controllers, station
from . import outputs, pneumatics
from .can_outputs import CanOutputs
from .created_devices import CreatedDevices
from .fields import INITIALIZED
from .modules import MODULES

_PCM_CHANNELS, _HUB_CHANNELS = 8, 16

#: Restores one output.
Restore = Callable[[], None]


class OutputGate:
    """Turns off the outputs of a robot that is not enabled, while its physics runs."""

    def __init__(self) -> None:
        self._channels = _Channels()
        self._can = CanOutputs()
        self._getters = _MotorGetters()
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
        self._outputs = outputs.Channels()
        self._pneumatics: list[tuple[Any, int]] = [
            *((pneumatics.Pcm(number), _PCM_CHANNELS) for number in range(MODULES)),
            *((pneumatics.Hub(number), _HUB_CHANNELS) for number in range(MODULES)),
        ]
        self._devices = CreatedDevices(
            [*self._outputs.initialized, *(INITIALIZED.slot(module) for module, _ in self._pneumatics)]
        )
        self._created: list[bool] | None = None
        self._switches: list[tuple[Callable[[], bool], Callable[[bool], None]]] = []

    def turn_off(self) -> Iterator[Restore]:
        """Turn off the outputs that are on."""
        created = self._devices.created()
        if created is not self._created:
            self._created = created
            self._find(created)
        yield from self._outputs.turn_off()
        for get, put in self._switches:
            if get():
                put(False)
                yield partial(outputs.restore, get, put, False, True)

    def _find(self, created: list[bool]) -> None:
        is_created = iter(created)
        self._switches = self._outputs.find(is_created)
        for module, channels in self._pneumatics:
            if next(is_created):
                self._switches += [pneumatics.solenoid(module, channel) for channel in range(channels)]


class _MotorGetters:
    """The `get` of motor controllers that return the value last set, and not that of the HAL.

    REV's ``SparkMax.get()`` is an example; a team's own motor controller class may be another.
    """

    def __init__(self) -> None:
        self._modules = 0
        self._classes: list[type[Any]] = []

    def turn_off(self) -> Iterator[Callable[[], None]]:
        """Make `get` return 0.

        :returns: a function for each class that restores it
        """
        if len(sys.modules) != self._modules:  # new modules may have new classes
            self._modules = len(sys.modules)
            self._classes = motor_controllers.with_own_getter()
        name = motor_controllers.POWER_GETTER
        for owner in self._classes:
            original = vars(owner)[name]
            setattr(owner, name, _zero)
            yield partial(setattr, owner, name, original)


def _zero(*_: object, **__: object) -> float:
    return 0.0
