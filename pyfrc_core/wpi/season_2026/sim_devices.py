"""SimDevices: what vendors and WPILib simulate that has no channel of the robot controller's."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, Literal, NamedTuple, TypeAlias

import hal
from hal import simulation as hs
from wpilib.simulation import SimDeviceSim

_reset = hs.resetSimDeviceData
#: The name of a SimDevice for a sensor of a SPARK; its first group is that of the SPARK.
_PART = re.compile(r"(SPARK (?:MAX|Flex) \[[\d,]+\]) .+")

#: A SimDevice that was opened by its name.
Device: TypeAlias = SimDeviceSim

#: Open a SimDevice by its name. It keeps the handle: to find that takes as long as to list the values.
open_device = SimDeviceSim

#: Return the handle of a SimDevice, by its name; 0 if there is none.
handle_of = hs.getSimDeviceHandle

#: Return the names of a SimDevice's values, each with whether only the device writes it.
values_of: Callable[[Device], list[tuple[str, bool]]] = SimDeviceSim.enumerateValues


def names() -> list[str]:
    """Return the names of the SimDevices that exist."""
    return SimDeviceSim.enumerateDevices("")


def forget_parts() -> None:
    """Remove what REV's library leaves of SPARKs that are gone, if there is no other SimDevice."""
    there = names()
    parts = list(filter(None, map(_PART.fullmatch, there)))
    if there and len(parts) == len(there) and not any(part[1] in there for part in parts):
        _reset()


class SimValue(NamedTuple):
    """The access to a value of a SimDevice.

    :param kind: its type; ``whole`` has 32 bits and ``long`` has 64
    :param options: what an option can be
    """

    kind: Literal["boolean", "number", "whole", "long", "option"]
    get: Callable[[], Any]
    set: Callable[[Any], None]
    options: tuple[str, ...]
    raw: hal.SimValue


def access(device: Device, name: str) -> SimValue:
    """Return the access to a value, which exists."""
    raw = device.getValue(name)
    if raw.type == hal.Type.ENUM:
        option = device.getEnum(name)
        return SimValue("option", option.get, option.set, tuple(SimDeviceSim.getEnumOptions(option)), raw)
    if raw.type == hal.Type.BOOLEAN:
        flag = device.getBoolean(name)
        return SimValue("boolean", flag.get, flag.set, (), raw)
    if raw.type == hal.Type.DOUBLE:
        number = device.getDouble(name)
        return SimValue("number", number.get, number.set, (), raw)
    if raw.type == hal.Type.INT:
        whole = device.getInt(name)
        return SimValue("whole", whole.get, whole.set, (), raw)
    long = device.getLong(name)
    return SimValue("long", long.get, long.set, (), raw)


def watch(value: SimValue, changed: Callable[[], None]) -> object:
    """Call a function for every write, even if the value does not change.

    :returns: an object that must be kept for as long as the function is to be called
    """
    return hs.registerSimValueChangedCallback(value.raw, lambda *_: changed(), False)


def only_robot_writes(value: SimValue) -> bool:
    """Return whether the value is an output only. `values_of` does not distinguish values for both directions; a
    callback receives the direction.
    """
    directions: list[int] = []
    hs.registerSimValueChangedCallback(value.raw, lambda _n, _h, direction, _v: directions.append(int(direction)), True)
    return directions == [hal.SimDevice.Direction.kOutput.value]
