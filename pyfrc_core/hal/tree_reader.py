"""Read every value of `hal_data` that may change during a run, for recordings and traces.

A trace reads them at each packet, so which function reads which value is looked up only when a device comes or goes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from .containers import LiveDict, LiveList, plain
from .paths import join
from .robot_devices import RobotDevices
from .sim_device_list import Signature
from .sim_devices import RobotDict, SimDevices

if TYPE_CHECKING:
    from . import driver_station

#: The path of a value, and the function that reads it as recordings have it.
_Leaf = tuple[str, Callable[[], Any]]


class TreeReader:
    """Reads the values of `HalData.leaves`.

    :param tree: `HalData`
    :param devices: its devices
    """

    def __init__(self, tree: LiveDict, devices: RobotDevices) -> None:
        self._tree, self._devices = tree, devices
        self._can: SimDevices = tree["CAN"]
        self._robot: RobotDict = tree["robot"]
        self._event: driver_station.EventData = tree["event"]
        self._sticks: list[driver_station.JoystickData] = list(tree["joysticks"])
        self._fixed = list(self._always())
        self._signature: Signature | None = None
        self._created: list[bool] = []
        self._read: list[Callable[[], Any]] = []
        self._read_paths: list[str] = []
        #: What decides about the paths that come and go without a device.
        self._shape: object = None
        self._paths: list[str] = []

    def read(self) -> tuple[list[str], list[Any]]:
        """Return all paths, in a list that stays the same while they do, and a new list of their values."""
        devices, created = self._can.signature(), self._devices.created()
        self._robot.sync(devices)
        if devices is not self._signature or created is not self._created:
            self._signature, self._created, self._shape = devices, created, None
            self._find()
        free, custom = self._robot.free(), self._tree["custom"]
        counts = [stick.counts() for stick in self._sticks]
        plugged = [(stick, count) for stick, count in zip(self._sticks, counts, strict=True) if any(count)]
        shape = counts, list(free), list(custom)
        if shape != self._shape:
            self._shape = shape
            self._paths = [*self._read_paths, *self._later_paths(plugged)]
        values = [read() for read in self._read]
        values += self._event.plain_values()
        for stick, count in plugged:
            values += stick.controls(*count)
        for stick, _ in plugged:
            values += stick.sent_back()
        if free or custom:
            values += [plain(value) for part in (free, custom) for value in part.values()]
        return self._paths, values

    def _find(self) -> None:
        """Find the functions that read the devices' values."""
        leaves = [*self._fixed, *self._present(), *self._bridged()]
        self._read_paths = [path for path, _ in leaves]
        self._read = [read for _, read in leaves]

    def _later_paths(self, plugged: list[tuple[driver_station.JoystickData, tuple[int, int, int]]]) -> Iterator[str]:
        """Return the paths of the values after those of `_find`."""
        yield from (join("event", key) for key in self._event.recorded)
        for stick, counts in plugged:
            # One value for all axes, and one for all buttons: lists that can be written back as a whole.
            kinds = zip(("axes", "buttons", "povs"), counts, strict=True)
            yield from (join(stick._path, kind) for kind, count in kinds if count)
        for stick, _ in plugged:
            yield from (join(stick._path, key) for key in stick.sent_keys)
        yield from (join("robot", key) for key in self._robot.free())
        yield from (join("custom", key) for key in self._tree["custom"])

    def _always(self) -> Iterator[_Leaf]:
        places = [device.place for device in self._devices.always()]
        for place in dict(zip(map(id, places), places, strict=True)).values():
            yield from _of(place)

    def _present(self) -> Iterator[_Leaf]:
        for device in self._devices.made():
            for each in device.place if isinstance(device.place, LiveList) else [device.place]:
                yield from _of(each)
        for name in sorted(self._can):
            yield from _of(self._can.device(name))

    def _bridged(self) -> Iterator[_Leaf]:
        for key, (device, value) in self._robot.bridged().items():
            (_, read), *_ = _of(device, value)
            yield join("robot", key), read


def _of(place: LiveDict, *keys: str) -> Iterator[_Leaf]:
    """Return the given fields of one dict; by default all that cannot be derived from others."""
    for key in keys or [key for key, slot in place._slots.items() if slot.recorded]:
        slot = place._slot(key)
        yield join(place._path, key), slot.plain or slot.get
