"""Vendors' devices on the CAN bus: their names, and the rows of motor controllers.

Known are REV's SPARKs and CTRE's devices of phoenix6. A SPARK's ``Setpoint`` is a power only in one of its control
modes, so its row names the mode and the unit.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

_SPARK = re.compile(r"SPARK (MAX|Flex) \[\d+\]")
_PHOENIX = re.compile(r"CAN\w*:(?P<kind>[^/\[\]]+?) \(v6\)\[(?P<number>\d+)\](?:/(?P<part>.+))?")

#: REV's control modes by the number in ``Control Mode``, each with the unit of its set-point.
_MODES = {
    0: ("duty cycle", ""),
    1: ("velocity", "velocity"),
    2: ("voltage", "V"),
    3: ("position", "position"),
    4: ("current", "A"),
    5: ("MAXMotion position", "position"),
    6: ("MAXMotion velocity", "velocity"),
}
#: The units of a SPARK's encoder if the robot has not changed its conversion factor.
_PLAIN_UNITS = {"velocity": "rpm", "position": "turns"}

#: The values that are an output from -1 to 1.
OUTPUTS = frozenset({"Applied Output", "dutyCycle"})

_UNITS = {
    "Bus Voltage": "V",
    "Motor Current": "A",
    "Motor Temperature": "°C",
    "Voltage": "V",
    "motorVoltage": "V",
    "supplyVoltage": "V",
    "supplyCurrent": "A",
    "torqueCurrent": "A",
}


class SetPoint(NamedTuple):
    """The set-point of a SPARK: its mode, and its unit, which is empty for the units of the robot's code."""

    mode: str
    unit: str

    def __str__(self) -> str:
        plain = "from -1 to 1" if self.mode == "duty cycle" else "in the units of the robot's code"
        return f"{self.mode}, {f'in {self.unit}' if self.unit else plain}"


def device_name(device: str) -> str:
    """Return the name that people know: ``Talon FX [3]`` for ``CANMotor:Talon FX (v6)[3]``."""
    match = _PHOENIX.fullmatch(device)
    return f"{match['kind']} [{match['number']}] {match['part'] or ''}".strip() if match else device


def set_point(device: str, devices: Mapping[Any, Mapping[Any, tuple[str, Any]]]) -> SetPoint | None:
    """Return the mode of a SPARK's set-point; None for other devices.

    :param devices: the path and value of each value, by device and name
    """
    if not _SPARK.fullmatch(device) or "Control Mode" not in devices[device]:
        return None
    mode, unit = _MODES.get(devices[device]["Control Mode"][1], ("unknown mode", ""))
    if unit in _PLAIN_UNITS:
        encoder = devices.get(f"{device} RELATIVE ENCODER", {})
        _, factor = encoder.get(f"{unit.capitalize()} Conversion Factor", ("", 1.0))
        unit = _PLAIN_UNITS[unit] if math.isclose(factor, 1.0) else ""
    return SetPoint(mode, unit)


def unit_of(name: str) -> str:
    """Return the unit of a value, by its name; empty if it is not known."""
    return _UNITS.get(name, "")


def changes_rows(path: str) -> bool:
    """Return whether a change of this value changes labels or units."""
    return path.endswith(('["Control Mode"]', 'Conversion Factor"]'))
