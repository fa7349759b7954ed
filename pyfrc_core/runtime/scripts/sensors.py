"""What a log measured, as targets of input scripts: ``hold:encoder[0].count``, ``hold:nt:/limelight/tx``.

A write to such a target is there after the physics of its packet, and again after that of each later packet, until
null is written: physics does not change what a log has. A device that the robot does not have is left out.

What a camera measured is published once, with the time of the write, after the physics of that packet or the next one.
What simulation code publishes there itself is left out: a subscriber would get both.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...compat.cpython_private import get_frame
from ...compat.unrepeatable import in_real_time
from ...errors import PyfrcError
from ...hal.paths import parse_path
from ...wpi import network_writes
from ..patch_table import PatchTable
from ..simulation_code import is_of_simulation
from .network_entries import NETWORK, NetworkEntries, parse_entry_target

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

#: Where cameras publish: Limelight, PhotonVision.
_OF_CAMERA = re.compile(r"/(limelight[^/]*|photonvision/[^/]+)/.+", re.DOTALL)


def camera_of(name: str) -> str | None:
    """Return the camera that an entry of NetworkTables is of, such as ``limelight``; None if it is of none."""
    found = _OF_CAMERA.fullmatch(name)
    return None if found is None else found[1]


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


def written_once(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return these writes without those that hold a sensor; what cameras measured is written, but not held.

    For runs that go on without the log: there, physics moves the sensors.
    """
    camera = HOLD + NETWORK
    return {
        target.removeprefix(HOLD): value
        for target, value in values.items()
        if not target.startswith(HOLD) or (target.startswith(camera) and value is not None)
    }


class Held:
    """The values that are held in one run.

    :param entries: writes those of NetworkTables
    """

    def __init__(self, hal_data: HalData, entries: NetworkEntries) -> None:
        self._hal_data, self._entries = hal_data, entries
        self._values: dict[str, Any] = {}
        #: Where `hal_data` has them.
        self._places: dict[str, tuple[Any, Any]] = {}
        #: What is to be published: the target, the value and its time; and the names of all entries that are held.
        self._news: list[tuple[str, Any, int]] = []
        self._names: set[str] = set()
        self._replaced = PatchTable()

    def write(self, target: str, value: object, now_us: int) -> None:
        """Hold a value from the end of this packet on; None leaves it to physics."""
        path = target.removeprefix(HOLD)
        if path.startswith(NETWORK):
            name, _ = parse_entry_target(path)
            if value is None:
                self._names.discard(name)
            else:
                self._names.add(name)
                self._news.append((path, value, now_us))
        elif value is None:
            self._values.pop(path, None)
        else:
            self._values[path] = math.inf if value == INFINITE else value

    def apply(self) -> None:
        """Write all values, in place of those of physics.

        :raises UsageError: when an entry of NetworkTables cannot have its value
        """
        for path, value in self._values.items():
            try:
                if path not in self._places:
                    self._places[path] = self._hal_data.locate(path)
                place, key = self._places[path]
                place[key] = value
            except (PyfrcError, LookupError):  # the robot does not have it, or not yet
                continue
        news, self._news = self._news, []
        for target, value, at_us in news:
            self._entries.write(target, value, at_us)

    def replace_simulation(self) -> None:
        """Leave out what simulation code publishes under a name that is held, until `close`."""
        for patch in list(network_writes.replacements(self._may_write)):
            self._replaced.patch(*patch)

    def close(self) -> None:
        """Leave nothing to later runs in this process."""
        self._replaced.undo()

    def _may_write(self, name: str) -> bool:
        return name not in self._names or not is_of_simulation(get_frame(1))
