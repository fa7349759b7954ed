"""What a log measured, as targets of input scripts: ``hold:encoder[0].count``.

A write to such a target is there after the physics of its packet, and again after that of each later packet, until
null is written: physics does not change what a log has. A device that the robot does not have is left out.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...compat.unrepeatable import in_real_time
from ...errors import PyfrcError
from ...hal.paths import parse_path

if TYPE_CHECKING:
    from ...hal import HalData

HOLD = "hold:"
#: An encoder's period when it stands: JSON has no word for it.
INFINITE = "inf"

_MEASURED = re.compile(
    r"(?:dio|counter)\[\d+\]\.value|(?:encoder|counter)\[\d+\]\.(?:count|period)|analog_in\[\d+\]\.voltage"
    r"|analog_gyro\[\d+\]\.(?:angle|rate)|duty_cycle\[\d+\]\.(?:output|frequency)|accelerometer\.[xyz]"
    r"|onboard_imu\.(?:yaw|(?:angle|gyro_rate|accel)_[xyz])|p(?:cm|h)_compressor\[\d+\]\.pressure_switch"
    r"|pdp\[\d+\]\.(?:voltage|temperature|current)|power\.vin_(?:voltage|current)|fpga_button"
)
#: The names of what SimDevices measure, and of settings and outputs with similar names.
_OF_DEVICES = re.compile(
    r"position|velocity|angle|angular|rotation|yaw|pitch|roll|rate|accel|range|distance|pressed|connected|valid"
    r"|current|voltage|temperature|[xyz]$",
    re.IGNORECASE,
)
_SETTINGS = re.compile(r"factor|offset|set.?point|limit|\bterm\b|\bm(?:ax|in)\b|units|mode|init", re.IGNORECASE)


def is_sensor(path: str) -> bool:
    """Return whether a path in `hal_data` is of a value that a device measures."""
    if _MEASURED.fullmatch(path):
        return True
    if not path.startswith("CAN[") or in_real_time(path):
        return False
    name = str(parse_path(path)[-1])
    return bool(_OF_DEVICES.search(name)) and not _SETTINGS.search(name)


def is_input(path: str, values: Mapping[str, object]) -> bool:
    """Return whether a sensor's channel is an input: a digital one can be an output, too."""
    return not path.startswith("dio[") or bool(values.get(path.replace(".value", ".is_input"), True))


def released(values: Mapping[str, object]) -> dict[str, object]:
    """Return the writes that leave to physics what is held after these writes."""
    return {target: None for target, value in values.items() if target.startswith(HOLD) and value is not None}


class Held:
    """The values that are held in one run."""

    def __init__(self, hal_data: HalData) -> None:
        self._hal_data = hal_data
        self._values: dict[str, Any] = {}
        #: Where `hal_data` has them.
        self._places: dict[str, tuple[Any, Any]] = {}

    def write(self, target: str, value: object) -> None:
        """Hold a value from the end of this packet on; None leaves it to physics."""
        path = target.removeprefix(HOLD)
        if value is None:
            self._values.pop(path, None)
        else:
            self._values[path] = math.inf if value == INFINITE else value

    def apply(self) -> None:
        """Write all values, in place of those of physics."""
        for path, value in self._values.items():
            try:
                if path not in self._places:
                    self._places[path] = self._hal_data.locate(path)
                place, key = self._places[path]
                place[key] = value
            except (PyfrcError, LookupError):  # the robot does not have it, or not yet
                continue
