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
from . import tree
from .can_outputs import CanOutputs
from .containers import LiveList, Slot

#: Restores one output.
Restore = Callable[[], None]


class OutputGate:
    """Turns off the outputs of a robot that is not enabled, while its physics runs."""

    def __init__(self) -> None:
        self._outputs = _Outputs()
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
        restores = [*self._outputs.turn_off(), *self._can.turn_off(), *self._getters.turn_off()]
        try:
            yield
        finally:
            self._closed = False
            for restore in restores:
                restore()


class _Outputs:
    """The outputs in the device table that the robot has created."""

    def __init__(self) -> None:
        self._created: list[bool] | None = None
        #: The access to what is turned off, and its value then, by device; and whether that is to be turned off.
        self._outputs: list[tuple[Callable[[], bool], list[tuple[Slot, Any]]]] = []

    def turn_off(self) -> Iterator[Restore]:
        """Turn off the outputs that are on."""
        created = tree().created()
        if created is not self._created:
            self._created, self._outputs = created, list(_find_outputs())
        for is_on, slots in self._outputs:
            for slot, off in slots if is_on() else ():
                before = slot.get()
                if before != off:
                    _put(slot, off)
                    yield partial(_restore, slot, off, before)


def _find_outputs() -> Iterator[tuple[Callable[[], bool], list[tuple[Slot, Any]]]]:
    for device in tree().devices():
        fields = [field for field in device.kind.fields if field.off is not None]
        for place in (device.place if isinstance(device.place, LiveList) else [device.place]) if fields else ():
            yield partial(device.kind.is_on, place), [(place._slot(field.name), field.off) for field in fields]


def _put(slot: Slot, value: Any) -> None:
    assert slot.set is not None
    slot.set(value)


def _restore(slot: Slot, off: Any, before: Any) -> None:
    """Restore an output, unless it was written meanwhile."""
    if slot.get() == off:
        _put(slot, before)


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
