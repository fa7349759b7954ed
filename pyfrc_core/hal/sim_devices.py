"""`CAN`: every SimDevice by name, as created by vendors and WPILib's gyros; `robot`: older names for some.

In Python, WPILib does not report new SimDevices, so names are looked up on each access.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from ..compat.unrepeatable import unrepeatable_devices
from ..wpi import sim_devices
from .containers import LiveDict, Slot
from .kinds import BOOL, FLOAT, INT32, INT64, UnknownKey, choice
from .paths import join
from .sim_device_list import Signature, sim_device_list


class SimDevice(LiveDict):
    """The values of one SimDevice. Values that the robot adds later, and a device that is created again, are found."""

    def __init__(self, name: str) -> None:
        super().__init__(join("CAN", name), dict)
        self._name = name
        self._handle = 0

    def refresh(self) -> None:
        """Read the list of the device's values again."""
        self._handle = sim_devices.handle_of(self._name)
        self._getters.clear()
        found: dict[str, Slot] = {}
        if self._handle:
            device = sim_devices.open_device(self._name)
            for value, _readonly in sim_devices.values_of(device):
                found[value] = _slot(device, value)
        self._built = found
        for watch_name, watch in self._watches.items():
            if watch_name in found and (connect := found[watch_name].watch):
                watch.store = connect(watch.fire)

    def _current(self) -> bool:
        return self._handle == sim_devices.handle_of(self._name) != 0

    def _slot(self, key: object) -> Slot:
        if not self._current() or key not in self._slots:
            self.refresh()
        return super()._slot(key)

    def __getitem__(self, key: object) -> Any:
        if not self._current():
            self.refresh()
        return super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        if not self._current() or key not in self._slots:
            self.refresh()
        return key in self._slots

    def __iter__(self) -> Iterator[str]:
        if not sim_devices.handle_of(self._name):
            return iter(())
        return iter([name for name, _ in sim_devices.values_of(sim_devices.open_device(self._name))])


_KINDS = {"boolean": BOOL, "number": FLOAT, "whole": INT32, "long": INT64}


def _slot(device: sim_devices.Device, name: str) -> Slot:
    value = sim_devices.access(device, name)
    get = plain = value.get
    if value.kind == "option":
        kind = choice({option: i for i, option in enumerate(value.options)})
        load = kind.load or int
        get = lambda: load(plain())  # noqa: E731
    else:
        kind = _KINDS[value.kind]
    return Slot(get, value.set, kind, lambda fire: sim_devices.watch(value, fire), plain=plain)


class SimDevices(LiveDict):
    """All SimDevices by name."""

    def __init__(self) -> None:
        super().__init__("CAN", dict)
        self._devices: dict[str, SimDevice] = {}
        self._signature: Signature = ()

    def __getitem__(self, key: Any) -> SimDevice:
        if key not in self:
            raise self._unknown(key, None if len(self) else "a SimDevice appears when the robot creates it")
        return self.device(key)

    def device(self, name: str) -> SimDevice:
        """Return the dict of a device, which need not exist."""
        device = self._devices.get(name)
        if device is None:  # not `or`: whether a device is empty takes listing its values
            device = self._devices[name] = SimDevice(name)
        return device

    def __setitem__(self, key: Any, value: Any) -> None:
        self[key].assign(value)

    def __contains__(self, key: object) -> bool:
        return isinstance(key, str) and sim_devices.handle_of(key) != 0

    def __iter__(self) -> Iterator[str]:
        return iter(sim_devices.names())

    def unrepeatable_devices(self) -> tuple[str, ...]:
        """Return the devices whose values do not repeat, as `compat.unrepeatable` names them."""
        return unrepeatable_devices(self)

    def signature(self) -> Signature:
        """Return the devices and their values, as the same object until one is created or removed.

        The changed devices are refreshed.
        """
        signature = sim_device_list.signature()
        if signature is not self._signature:
            self._signature = signature
            for name, handle, values in signature:
                device = self.device(name)
                if device._handle != handle or tuple(device._slots) != values:
                    device.refresh()
        return signature


class Bridge(NamedTuple):
    """The names in `robot` for a kind of SimDevice.

    :param device: a pattern for the SimDevice's name; its first group is the port
    :param keys: the beginnings of the keys, with ``{}`` for the port
    :param things: the end of each key, and the value that it stands for
    """

    device: re.Pattern[str]
    keys: tuple[str, ...]
    things: dict[str, str]


_AXES = {axis: axis for axis in "xyz"}
# Degrees and degrees per second about the vertical axis, which is z unless the robot sets another one.
_ADIS = {
    "angle": "gyro_angle_z",
    "rate": "gyro_rate_z",
    **{f"{what}_{axis}": f"{gyro}_{axis}" for axis in "xyz" for what, gyro in
       (("angle", "gyro_angle"), ("rate", "gyro_rate"), ("accel", "accel"))},
}  # fmt: skip
BRIDGES = (
    Bridge(re.compile(r"Gyro:ADXRS450\[(\d+)\]"), ("adxrs450_spi_{}",), {"angle": "angle_x", "rate": "rate_x"}),
    Bridge(re.compile(r"Gyro:ADIS16448\[(\d+)\]"), ("adis16448_spi_{}",), _ADIS),
    Bridge(re.compile(r"Gyro:ADIS16470\[(\d+)\]"), ("adis16470_spi_{}",), _ADIS),
    Bridge(re.compile(r"Accel:ADXL345_SPI\[(\d+)\]"), ("adxl345_spi_{}",), _AXES),
    Bridge(re.compile(r"Accel:ADXL345_I2C\[(\d+),\d+\]"), ("adxl345_i2c_{}",), _AXES),
    Bridge(re.compile(r"Accel:ADXL362\[(\d+)\]"), ("adxl362_spi_{}",), _AXES),
    Bridge(
        re.compile(r"navX-Sensor\[(\d+)\]"),
        ("navx_spi_{}", "navx_i2c_{}", "navxmxp_spi_{}", "navxmxp_i2c_{}"),
        {
            "angle": "Yaw",
            "yaw": "Yaw",
            "pitch": "Pitch",
            "roll": "Roll",
            "rate": "Rate",
            "compass": "CompassHeading",
            "fused": "FusedHeading",
        },
    ),
)


def bridged(name: str, values: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Return the keys in `robot` for the SimDevice `name`, each with the value that it stands for."""
    there = set(values)
    for bridge in BRIDGES:
        if match := bridge.device.fullmatch(name):
            for key in bridge.keys:
                for thing, value in bridge.things.items():
                    if value in there:
                        yield f"{key.format(match[1])}_{thing}", value


class RobotDict(LiveDict):
    """Free keys for devices, such as ``adxrs450_spi_0_angle`` (degrees); `get` returns 0 for a missing one.

    A key for a value of a SimDevice reads and writes that value. If it is written before the robot creates the device,
    the value is stored, and written when the device is found: by the next access to the key, by `sync`, or by a
    recording.
    """

    def __init__(self, devices: SimDevices) -> None:
        super().__init__("robot", dict)
        self._devices = devices
        self._signature: Signature = ()
        self._free: dict[str, Any] = {}
        self._bridged: dict[str, tuple[SimDevice, str]] = {}

    @property
    def waits_for_devices(self) -> bool:
        """Whether there is a value or a listener that may be meant for a device that does not exist yet."""
        return bool(self._free or self._watches)

    def sync(self, signature: Signature | None = None) -> None:
        """Find new devices, and write the values that were stored for them."""
        signature = self._devices.signature() if signature is None else signature
        if signature is self._signature:
            return
        self._signature = signature
        self._bridged = {
            key: (self._devices.device(name), value)
            for name, _handle, values in signature
            for key, value in bridged(name, values)
        }
        for key in [key for key in self._free if key in self._bridged]:
            device, value = self._bridged[key]
            device[value] = self._free.pop(key)
        for key in [key for key in self._watches if key in self._bridged]:
            for _key, callback in self._watches.pop(key).listeners:
                self.register(key, callback)

    def _bridge(self, key: object) -> tuple[SimDevice, str] | None:
        found = self._bridged.get(key)  # type: ignore[call-overload]
        if found is None or not found[0]._current():
            self.sync()
            found = self._bridged.get(key)  # type: ignore[call-overload]
        return found  # type: ignore[no-any-return]

    def __getitem__(self, key: Any) -> Any:
        if bridge := self._bridge(key):
            return bridge[0][bridge[1]]
        try:
            return self._free[key]
        except KeyError:
            raise self._unknown(key) from None

    def __setitem__(self, key: object, value: object) -> None:
        if not isinstance(key, str):
            raise UnknownKey(f"a key of robot is a string, not {key!r}", where=join("robot", key))
        if bridge := self._bridge(key):
            bridge[0][bridge[1]] = value
            return
        self._free[key] = value
        if key in self._watches:
            self._watches[key].fire()

    def __delitem__(self, key: object) -> None:
        if key not in self._free:
            raise self._unknown(key)
        del self._free[key]

    def free(self) -> dict[str, Any]:
        """Return the keys that do not stand for a device's value, with their values."""
        return self._free

    def bridged(self) -> dict[str, tuple[SimDevice, str]]:
        """Return the keys that stand for a device's value, each with the device and the name of the value."""
        return self._bridged

    def clear(self) -> None:
        """Remove the keys that do not stand for a device's value."""
        self._free.clear()

    def __contains__(self, key: object) -> bool:
        return key in self._free or self._bridge(key) is not None

    def __iter__(self) -> Iterator[str]:
        self.sync()
        return iter([*self._free, *self._bridged])

    def get(self, key: object, default: object = 0) -> Any:
        """Return the value at `key`, or 0 if it is missing."""
        return super().get(key, default)

    def register(self, key: Any, callback: Callable[[Any, Any], object], notify: bool = False) -> None:
        """Register a listener, as for every dict, but also for a key that was never set."""
        if bridge := self._bridge(key):
            bridge[0].register(bridge[1], lambda _key, value: callback(key, value), notify)
            return
        self._built = {**self._slots, key: Slot(lambda: self.get(key), None)}
        super().register(key, callback, notify)
