"""The outputs of CAN motor controllers, which vendors' libraries show as values of SimDevices.

A SimDevice does not mark the value that drives the motor, so names decide. Known from REV's library (``SPARK MAX [5]``:
``Setpoint``, ``Applied Output``) and CTRE's (``CANMotor:Talon FX (v6)[3]``: ``dutyCycle``, ``motorVoltage``).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import hal
from hal import simulation as hs
from wpilib.simulation import SimDeviceSim

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
    raw: hal.SimValue
    get: Callable[[], Any]
    put: Callable[[Any], None]
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
            value = output.get()
            if value and (output.is_position is None or not output.is_position()):
                output.put(type(value)(0))
                yield _Written(output, value).restore


class _Written:
    """An output that is turned off. It detects writes in the meantime, such as those of a vendor's model."""

    def __init__(self, output: _Output, before: object) -> None:
        self._output, self._before = output, before
        self._written = False
        # Called for every write, even if the value does not change.
        self._watch: object = hs.registerSimValueChangedCallback(output.raw, self._note, False)

    def _note(self, *_: object) -> None:
        self._written = True

    def restore(self) -> None:
        self._watch = None
        if not self._written:
            self._output.put(self._before)


def _outputs_of(name: str, values: tuple[str, ...]) -> Iterator[_Output]:
    device = SimDeviceSim(name)
    is_motor = bool(_MOTOR.search(name)) and not _NO_MOTOR.search(name)
    mode = next((value for value in values if _plain(value) == _MODE), None)
    for value in values:
        raw, what = device.getValue(value), _plain(value)
        if raw.type == hal.Type.DOUBLE:
            access: Any = device.getDouble(value)
        elif raw.type == hal.Type.INT:
            access = device.getInt(value)
        else:
            continue
        if what in _OUTPUTS or (what in _COMMANDS and is_motor and _only_robot_writes(raw)):
            yield _Output(raw, access.get, access.set, None)
        elif what == _SETPOINT and (is_motor or _only_robot_writes(raw)):
            yield _Output(raw, access.get, access.set, None if mode is None else partial(_is_position, device, mode))


def _only_robot_writes(raw: hal.SimValue) -> bool:
    """Return whether the value is an output only. `enumerateValues` does not distinguish values for both directions; a
    callback receives the direction.
    """
    directions: list[int] = []
    hs.registerSimValueChangedCallback(raw, lambda _n, _h, direction, _v: directions.append(int(direction)), True)
    return directions == [hal.SimDevice.Direction.kOutput.value]


def _is_position(device: SimDeviceSim, mode: str) -> bool:
    raw = device.getValue(mode)
    if raw.type == hal.Type.ENUM:
        value = device.getEnum(mode)
        options = SimDeviceSim.getEnumOptions(value)
        return re.search("position|motion", options[value.get()], re.IGNORECASE) is not None
    return raw.type == hal.Type.INT and device.getInt(mode).get() in _POSITION_MODES


def _plain(name: str) -> str:
    return name.replace(" ", "").lower()
