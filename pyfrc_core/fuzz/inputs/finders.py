"""Find a robot's inputs: the controls of its joysticks, and the sensors that it has created.

Inputs from the dashboard are in `dashboard_generator`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from typing import NamedTuple

from ...hal import HalData, counters, device_table, format_path
from ...hal.modules import Modules
from ...hal.sim_device_list import Signature
from ...runtime.scripts.targets import OPMODE
from ...season import CURRENT
from ...wpi import devices, joysticks, names, station
from .values import UNKNOWN, Input, InputKind, RobotConstants

# -- joysticks -------------------------------------------------------------------------------------------------------


def find_controls(hal_data: HalData, gamepads: Mapping[int, str]) -> Iterator[Input]:
    """Return the axes, buttons and POVs of the joysticks that are plugged in."""
    for number, stick in enumerate(hal_data["joysticks"]):
        yield from _controls(number, *stick.counts(), joysticks.TRIGGERS.get(gamepads.get(number, ""), ()))


@cache
def _controls(number: int, axes: int, buttons: int, povs: int, triggers: tuple[int, ...]) -> tuple[Input, ...]:
    name = f"joysticks[{number}]"
    return (
        *(Input(f"{name}.axes[{axis}]", "trigger" if axis in triggers else "axis", name) for axis in range(axes)),
        *(
            Input(f"{name}.buttons[{button}]", "button", name)
            for button in range(CURRENT.first_button, CURRENT.first_button + buttons)
        ),
        *(Input(f"{name}.povs[{pov}]", "pov", name) for pov in range(povs)),
    )


# -- sensors ---------------------------------------------------------------------------------------------------------

#: The values that devices measure, by their key in `hal_data`.
_DEVICES: dict[str, tuple[tuple[str, InputKind], ...]] = {
    "dio": (("value", "switch"),),
    "analog_in": (("voltage", "volts"),),
    "encoder": (("count", "count"), ("rate", "rate")),
    "analog_gyro": (("angle", "angle"), ("rate", "turning")),
    "duty_cycle": (("output", "turns"), ("frequency", "hertz")),
}
#: Those of devices of which there is only one.
_GROUPS: dict[str, tuple[tuple[str, InputKind], ...]] = {
    "accelerometer": (("x", "acceleration"), ("y", "acceleration"), ("z", "acceleration")),
    "onboard_imu": (
        ("yaw", "radians"),
        *((f"angle_{axis}", "radians") for axis in "xyz"),
        *((f"gyro_rate_{axis}", "radians per second") for axis in "xyz"),
        *((f"accel_{axis}", "m/s2") for axis in "xyz"),
    ),
}
#: What a digital input measures that a `Counter` counts.
_COUNTED: tuple[tuple[str, InputKind], ...] = (("value", "pulses"),)
_MODULES: dict[str, tuple[tuple[str, InputKind], ...]] = {
    "pcm_compressor": (("pressure_switch", "switch"),),
    "ph_compressor": (("pressure_switch", "switch"),),
    "pdp": (("voltage", "battery"), *((f"current[{channel}]", "amperes") for channel in range(24))),
}

#: What the robot's controller measures, by its path: varied only where code asks for it.
_OF_CONTROLLER: dict[str, InputKind] = {"roborio.cpu_temp": "celsius", "power.vin_current": "amperes"}
for _rail in ("3v3", "5v", "6v"):
    _OF_CONTROLLER |= {
        f"power.user_voltage_{_rail}": "rail",
        f"power.user_current_{_rail}": "amperes",
        f"power.user_active_{_rail}": "switch",
        f"power.user_faults_{_rail}": "whole",
    }

#: Patterns for a SimDevice and its numeric value, as ``device/value``; the first match counts.
_OF_DEVICES: tuple[tuple[str, InputKind], ...] = (
    (r"^SPARK.*(?<!ABSOLUTE ENCODER)(?<!ANALOG SENSOR)/Position$", "rotations"),
    (r"^SPARK.*/Velocity$", "rpm"),
    (r"(CANcoder|Talon FX).*/rawPosition", "rotations"),
    (r"Pigeon.*/rawYaw", "angle"),
    (r"Pigeon.*/angularVel", "turning"),
)
#: Patterns for the names of other numeric values; the first match counts.
_NAMED: tuple[tuple[str, InputKind], ...] = (
    (r"rate|velocity", "turning"),
    (r"yaw|pitch|roll", "half turns"),
    (r"heading", "heading"),
    (r"angle", "angle"),
    (r"accel|^[xyz]$", "acceleration"),
    (r"range|distance", "range"),
    (r"voltage", "battery"),
    (r"current", "amperes"),
)


#: Modules on the CAN bus are looked for in the first searches, and in every fourth later: there are 189 possible ones.
_FIRST_SEARCHES, _SEARCHES_FOR_MODULES = 4, 4


class SensorFinder:
    """Finds what the robot's sensors measure; searches again only after a device was created or removed."""

    def __init__(self, hal_data: HalData, constants: RobotConstants = UNKNOWN) -> None:
        self._hal_data = hal_data
        self._constants = constants
        self._seen: object = None
        self._found: list[Input] = []
        self._searches = 0
        self._there: tuple[bool, ...] = ()

    def find(self) -> list[Input]:
        """Return the sensors' values in order: the same list until the robot's devices change."""
        there = self._devices()
        if there != self._seen:
            self._seen = there
            self._found = sorted(find_sensors(self._hal_data, self._constants, any(self._there)))
        return self._found

    def _devices(self) -> _Devices:
        hal_data = self._hal_data
        if self._searches < _FIRST_SEARCHES or self._searches % _SEARCHES_FOR_MODULES == 0:
            self._there = tuple([exists() for exists in _modules()])
        self._searches += 1
        groups, sim_devices = tuple(_groups(hal_data)), hal_data["CAN"].signature()
        opmodes = tuple(each.name for each in station.published_opmodes())
        return _Devices(_used(), self._there, groups, sim_devices, counters.counted_channels(), opmodes)


class _Devices(NamedTuple):
    """The devices that exist: those of the controller that have a sensor, and all others; and the opmodes.

    :param groups: devices of which there is only one
    :param counted: the digital inputs that counters count
    """

    channels: tuple[tuple[str, int], ...]
    modules: tuple[bool, ...]
    groups: tuple[str, ...]
    sim_devices: Signature
    counted: frozenset[int]
    opmodes: tuple[str, ...]


@cache
def _channels() -> list[tuple[tuple[str, int], Callable[[], bool]]]:
    """Return the roboRIO's channels for sensors, each with a function that returns whether the robot uses it."""
    return [
        ((kind.name, number), slot.get)
        for kind in device_table.KINDS
        if kind.name in _DEVICES
        for number, slot in enumerate(kind.initialized())
    ]


@cache
def _modules() -> list[Callable[[], bool]]:
    """Return a function for each possible module on the CAN bus that returns whether the robot has created it."""
    return [slot.get for slot in Modules().initialized()]


def prepare_search() -> None:
    """Prepare a search for inputs: forks of this process then find it prepared."""
    _channels()
    _modules()
    for number in range(station.JOYSTICKS):
        for triggers in {(), *joysticks.TRIGGERS.values()}:
            _controls(number, station.AXES, station.BUTTONS, station.POVS, triggers)


def _groups(hal_data: HalData) -> list[str]:
    """Return which of the devices of which there is only one exist."""
    return [group for group, exists in device_table.MAY_EXIST.items() if hal_data[group][exists]]


def _used() -> tuple[tuple[str, int], ...]:
    """Return the roboRIO's channels for sensors that the robot uses."""
    return tuple([channel for channel, exists in _channels() if exists()])


def find_sensors(hal_data: HalData, constants: RobotConstants = UNKNOWN, has_modules: bool = True) -> Iterator[Input]:
    """Return what the robot's sensors measure; outputs of SimDevices are left out.

    :param constants: tells what the robot's code asks its controller for
    :param has_modules: whether there may be modules on the CAN bus; if not, they are not searched
    """
    for target, kind in _OF_CONTROLLER.items():
        if target in names.ASKED_BY and constants.asks(names.ASKED_BY[target]):
            yield Input(target, kind, target)
    channels = _used()
    if opmodes := station.published_opmodes():
        yield Input(OPMODE, "option", "opmode", tuple(sorted({each.name for each in opmodes})))
    yield Input("power.vin_voltage", "battery", "power")
    for key in device_table.BUTTONS:
        yield Input(key, "switch", key)
    for group in _groups(hal_data):
        for value, kind in _GROUPS[group]:
            yield Input(f"{group}.{value}", kind, group)
    wired, counted = _wired(hal_data, channels), counters.counted_channels()
    for key, number in channels:
        if hal_data[key][number].get("is_input", True) and (key, number) not in wired:
            for value, kind in _DEVICES[key] if key != "dio" or number not in counted else _COUNTED:
                yield Input(f"{key}[{number}].{value}", kind, f"{key}[{number}]")
    for key, values in _MODULES.items() if has_modules else ():
        for number in hal_data[key]:
            if key == "pdp" and constants.asks(names.ASKED_BY["pdp.temperature"]):
                yield Input(f"pdp[{number}].temperature", "celsius", f"pdp[{number}]")
            for value, kind in values:
                yield Input(f"{key}[{number}].{value}", kind, f"{key}[{number}]")
    for name in hal_data["CAN"]:
        yield from _of_sim_device(name)


def _wired(hal_data: HalData, channels: Iterable[tuple[str, int]]) -> set[tuple[str, int | None]]:
    """Return the channels that encoders and gyros use; they are not sensors of their own."""
    encoders = [hal_data[key][number]["config"] for key, number in channels if key == "encoder"]
    return {("dio", wire) for config in encoders for wire in config.values()} | {
        ("analog_in", number) for key, number in channels if key == "analog_gyro"
    }


def _kind_of_number(device: str, value: str) -> InputKind:
    for pattern, kind in _OF_DEVICES:
        if re.search(pattern, f"{device}/{value}"):
            return kind
    return next((kind for pattern, kind in _NAMED if re.search(pattern, value, re.IGNORECASE)), "turns")


def _of_sim_device(name: str) -> Iterator[Input]:
    for value, is_output, sort, options in devices.sim_values(name):
        if is_output:
            continue
        kind: InputKind
        if sort == "boolean":
            kind = "connected" if re.search("connected|valid", value, re.IGNORECASE) else "switch"
        elif sort == "option":
            kind = "option"
        elif sort == "number":
            kind = _kind_of_number(name, value)
        else:
            kind = "celsius" if re.search("temperature", value, re.IGNORECASE) else "whole"
        if kind == "battery" and name.endswith("ANALOG SENSOR"):
            kind = "volts"
        if kind != "option" or options:
            yield Input(format_path(("CAN", name, value)), kind, format_path(("CAN", name)), options)
