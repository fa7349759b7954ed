"""Setting values of a robot that drives: only values that it publishes, and only by who has switched it on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ...errors import UsageError
from ...season import CURRENT
from ...wpi.network_news import PLAIN_TYPES
from ..engine.messages import TYPE, VALUE

#: What WPILib says of the robot, which no one else sets.
_OF_WPILIB = ("/FMSInfo/", "/DriverStation/", "/.schema/", "/LiveWindow/.status/", "/CameraPublisher/")
OFF = "Tuning is off: switch it on in the top bar to set values on the robot."


class Tuner:
    """One person's right to set values, which is off until it is switched on.

    :param write: sets values by target
    :param tuners: the people who have switched it on
    :param last_left: called when none of them is left
    """

    def __init__(
        self, write: Callable[[Mapping[str, object]], object], tuners: set[Tuner], last_left: Callable[[], object]
    ) -> None:
        self._write, self._tuners, self._last_left = write, tuners, last_left

    def tune(self, on: bool) -> None:
        """Switch it on or off."""
        if on:
            self._tuners.add(self)
        elif self in self._tuners:
            self._tuners.discard(self)
            if not self._tuners:
                self._last_left()

    def write(self, values: Mapping[str, object]) -> None:
        """Set values by target, such as ``nt:/SmartDashboard/kP``.

        :raises UsageError: when it is off, or a value cannot be set
        """
        if self not in self._tuners:
            raise UsageError(OFF)
        self._write(values)

    def leave(self) -> None:
        """Switch it off."""
        self.tune(False)


def checked_write(target: str, value: object, values: Mapping[str, Any]) -> tuple[str, str, Any]:
    """Return the topic's name, its type, and the value that it gets.

    :param values: those of the robot, by path
    :raises UsageError: when the robot has no such value, or cannot have this one
    """
    name = target.removeprefix(VALUE)
    type_name = values.get(TYPE + name)
    chooser = name.removesuffix(f"/{CURRENT.dashboards.choice}")
    if type_name is None and chooser != name and f"{VALUE}{chooser}/options" in values:
        type_name = "string"  # robots publish what can be chosen, and dashboards what is
    if not target.startswith(VALUE) or type_name is None:
        raise UsageError(f"the robot publishes no value {target}")
    if name.startswith(_OF_WPILIB) or "/." in name or type_name not in PLAIN_TYPES:
        raise UsageError(f"{name} cannot be set from here")
    kind = PLAIN_TYPES[type_name]
    if not type_name.endswith("[]"):
        return name, type_name, _converted(name, kind, value)
    if not isinstance(value, (list, tuple)):
        raise UsageError(f"{name}: a list is needed, not {value!r}")
    return name, type_name, [_converted(name, kind, each) for each in value]


def _converted(name: str, kind: type, value: object) -> Any:
    if isinstance(value, kind) and (kind is bool or not isinstance(value, bool)):
        return value
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if kind is int and isinstance(value, float) and value.is_integer():
        return int(value)
    raise UsageError(f"{name}: {_NAMES[kind]} is needed, not {value!r}")


_NAMES = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
