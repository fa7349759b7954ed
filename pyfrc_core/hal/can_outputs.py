"""The outputs of CAN motor controllers, which vendors' libraries show as values of SimDevices.

A SimDevice does not mark the value that drives the motor, so names decide. Known from REV's library (``SPARK MAX [5]``:
``Setpoint``, ``Applied Output``) and CTRE's (``CANMotor:Talon FX (v6)[3]``: ``dutyCycle``, ``motorVoltage``).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

from ..wpi import sim_devices
from .sim_device_list import Signature, sim_device_list

#: Patterns for the device names of motor controllers, and of other devices on the bus.
_MOTOR = re.compile(r"motor|talon|victor|spark|venom|nova|titan|jaguar", re.IGNORECASE)
_NO_MOTOR = re.compile(r"encoder|sensor|switch|limit|gyro|imu|candio|canain", re.IGNORECASE)

# Names in small letters, without spaces.
#: Names that are always a motor's output.
_OUTPUTS = {
    "appliedoutput",
    "appliedvoltage",
    "motoroutput",
    "motoroutputleadvoltage",
    "motorvoltage",
    "outputpercent",
    "outputvoltage",
    "percentoutput",
    "throttle",
}
#: Names that are an output in a motor controller, if only the robot's code writes the value.
_COMMANDS = {
    "arbitraryfeedforward",
    "command",
    "demand",
    "dutycycle",
    "output",
    "percent",
    "power",
    "set",
    "speed",
    "value",
    "velocity",
    "voltage",
}
_SETPOINT, _MODE = "setpoint", "controlmode"
#: REV's control modes in which a setpoint is a position: a motor that is off does not move to 0.
_POSITION_MODES = (3, 5)


class _Output(NamedTuple):
    value: sim_devices.SimValue
    #: Whether the value is a target position.
    is_position: Callable[[], bool] | None


class CanOutputs:
    """The outputs of all CAN motor controllers."""

    def __init__(self) -> None:
        self._devices: Signature = ()
        self._outputs: list[_Output] = []

    def turn_off(self) -> Iterator[Callable[[], None]]:
        """Turn off the outputs that are on.

        :returns: a function for each of them that restores it
        """
        devices = sim_device_list.signature()
        if devices is not self._devices:
            self._devices = devices
            self._outputs = [output for name, _handle, values in devices for output in _outputs_of(name, values)]
        for output in self._outputs:
            value = output.value.get()
            if value and (output.is_position is None or not output.is_position()):
                output.value.set(type(value)(0))
                yield _Written(output, value).restore


class _Written:
    """An output that is turned off. It detects writes in the meantime, such as those of a vendor's model."""

    def __init__(self, output: _Output, before: object) -> None:
        self._output, self._before = output, before
        self._written = False
        self._watch: object = sim_devices.watch(output.value, self._note)

    def _note(self) -> None:
        self._written = True

    def restore(self) -> None:
        self._watch = None
        if not self._written:
            self._output.value.set(self._before)


def _outputs_of(name: str, values: tuple[str, ...]) -> Iterator[_Output]:
    device = sim_devices.open_device(name)
    is_motor = bool(_MOTOR.search(name)) and not _NO_MOTOR.search(name)
    mode = next((value for value in values if _plain(value) == _MODE), None)
    for each in values:
        value, what = sim_devices.access(device, each), _plain(each)
        if value.kind not in ("number", "whole"):
            continue
        if what in _OUTPUTS or (what in _COMMANDS and is_motor and sim_devices.only_robot_writes(value)):
            yield _Output(value, None)
        elif what == _SETPOINT and (is_motor or sim_devices.only_robot_writes(value)):
            yield _Output(value, None if mode is None else partial(_is_position, device, mode))


def _is_position(device: sim_devices.Device, mode: str) -> bool:
    value = sim_devices.access(device, mode)
    if value.kind == "option":
        return re.search("position|motion", value.options[value.get()], re.IGNORECASE) is not None
    return value.kind == "whole" and value.get() in _POSITION_MODES


def _plain(name: str) -> str:
    return name.replace(" ", "").lower()
