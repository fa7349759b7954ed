"""The names that robot code gives to its sensors: the attributes they are in."""

from __future__ import annotations

from collections.abc import Mapping

from ...hal.paths import format_path
from ...wpi import devices


class DeviceNames(dict[str, str]):
    """Names of sensors, by what they are in `hal_data`: "gyro", "elevator.limit on DIO 4"."""

    def add(self, path: str, value: object) -> None:
        """Note an attribute's value, if it is a sensor that has no name yet.

        :param path: the attribute, from the robot: ``container.elevator._motor``
        """
        if (sensor := devices.sensor(value)) is not None:
            attribute = ".".join(part.lstrip("_") for part in path.split(".")[-2:])
            self.setdefault(format_path(sensor.place), attribute + sensor.where)


def named(target: str, names: Mapping[str, str]) -> str:
    """Return a target of an input script with the name that the robot's code has for the sensor."""
    for key, name in names.items():
        if target.startswith(key) and target[len(key) : len(key) + 1] in (".", "["):
            rest = target[len(key) :].strip('.[]"')
            return name if rest == "value" else f"{name} {rest}"
    return target
