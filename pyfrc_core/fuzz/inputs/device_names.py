"""The names that robot code gives to its sensors: the attributes they are in."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from ...hal.paths import format_path

#: How to find what a sensor is in `hal_data`, and how a story says where it is, by the name of its class.
_PLACES: dict[str, Callable[[Any], tuple[str, str]]] = {
    "DigitalInput": lambda each: (f"dio[{each.getChannel()}]", f" on DIO {each.getChannel()}"),
    "AnalogInput": lambda each: (f"analog_in[{each.getChannel()}]", f" on analog input {each.getChannel()}"),
    "AnalogEncoder": lambda each: (f"analog_in[{each.getChannel()}]", f" on analog input {each.getChannel()}"),
    "Encoder": lambda each: (f"encoder[{each.getFPGAIndex()}]", ""),
    "DutyCycleEncoder": lambda each: (f"duty_cycle[{each.getFPGAIndex()}]", f" on DIO {each.getSourceChannel()}"),
    "Ultrasonic": lambda each: (_can(f"Ultrasonic[{each.getEchoChannel()}]"), f" on DIO {each.getEchoChannel()}"),
    "ADXRS450_Gyro": lambda each: (_can(f"Gyro:ADXRS450[{each.getPort()}]"), ""),
    "ADIS16470_IMU": lambda each: (_can(f"Gyro:ADIS16470[{each.getPort()}]"), ""),
    "ADIS16448_IMU": lambda each: (_can(f"Gyro:ADIS16448[{each.getPort()}]"), ""),
    "SparkMax": lambda each: (_can(f"SPARK MAX [{each.getDeviceId()}]"), ""),
    "SparkFlex": lambda each: (_can(f"SPARK Flex [{each.getDeviceId()}]"), ""),
}


def _can(name: str) -> str:
    return format_path(("CAN", name))


class DeviceNames(dict[str, str]):
    """Names of sensors, by what they are in `hal_data`: "gyro", "elevator.limit on DIO 4"."""

    def add(self, path: str, value: object) -> None:
        """Note an attribute's value, if it is a sensor that has no name yet.

        :param path: the attribute, from the robot: ``container.elevator._motor``
        """
        for kind in type(value).__mro__[:-1]:
            if (place := _PLACES.get(kind.__name__)) is not None:
                with suppress(Exception):  # a sensor that is closed, or a class of the robot's with that name
                    key, where = place(value)
                    attribute = ".".join(part.lstrip("_") for part in path.split(".")[-2:])
                    self.setdefault(key, attribute + where)
                return


def named(target: str, names: Mapping[str, str]) -> str:
    """Return a target of an input script with the name that the robot's code has for the sensor."""
    for key, name in names.items():
        if target.startswith(key) and target[len(key) : len(key) + 1] in (".", "["):
            rest = target[len(key) :].strip('.[]"')
            return name if rest == "value" else f"{name} {rest}"
    return target
