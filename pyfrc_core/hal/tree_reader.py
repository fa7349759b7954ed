"""Read every value of `hal_data` that may change during a run, as ``(path, value)`` pairs, for recordings and traces.

The list of values is built again only after a device was created or removed, and the values of joysticks and of the
event only after their bytes have changed: a trace reads them at each packet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import hal.simulation

from . import driver_station
from .containers import LiveDict, Slot, plain
from .devices import KINDS
from .modules import Modules
from .paths import join

Leaf = tuple[str, Callable[[], Any]]


class TreeReader:
    """Reads the values of `HalData.leaves` from a prepared list."""

    def __init__(self, tree: LiveDict, modules: Modules) -> None:
        self._tree = tree
        self._modules = modules
        self._always = list(self._fixed())
        event = list(_of(tree["event"]))
        self._rarely_changed = [
            _RarelyChanged(tree["event"].fingerprint, lambda: [(path, get()) for path, get in event]),
            *(_RarelyChanged(stick.fingerprint, partial(_stick, stick)) for stick in tree["joysticks"]),
        ]
        initialized = [(kind, kind.initialized()) for kind in KINDS]
        self._kinds = [(kind, [slot.get for slot in channels]) for kind, channels in initialized]
        slots = [slot for _, channels in initialized for slot in channels]
        slots += [*modules.initialized(), tree["accelerometer"]._slot("active")]
        self._devices = CreatedDevices(slots)
        self._state: Any = None
        self._here: list[str] = []
        self._reads: list[Callable[[], Any]] = []
        self._free: list[str] = []
        self._paths: list[str] = []

    def any_exist(self) -> bool:
        """Return whether any device exists, or any thread of WPILib that waits for an alarm."""
        created = any(self._devices.created()) or bool(self._tree["CAN"].signature())
        return created or hal.simulation.getNumNotifiers() > 0

    def existing(self) -> list[str]:
        """Return the devices that exist, such as ``pwm[3]``, and finally whether a WPILib thread waits for an alarm."""
        slots = [join(kind.name, index) for kind in KINDS for index, _ in enumerate(kind.initialized())]
        slots += ["pneumatics or power distribution"] * len(list(self._modules.initialized()))
        slots.append("accelerometer")
        names = [name for name, there in zip(slots, self._devices.created(), strict=True) if there]
        if self._tree["CAN"].signature():
            names += [join("CAN", name) for name in sorted(self._tree["CAN"])]
        return names + ["a notifier"] * (hal.simulation.getNumNotifiers() > 0)

    def read(self) -> tuple[list[str], list[Any]]:
        """Return the paths, as the same list object while they do not change, and the value of each."""
        tree = self._tree
        devices = tree["CAN"].signature()
        tree["robot"].sync(devices)
        state = (self._devices.created(), devices)
        others = state != self._state
        if others:
            self._state = state
            leaves = [*self._always, *self._present()]
            self._here, self._reads = [path for path, _ in leaves], [read for _, read in leaves]
        values = [read() for read in self._reads]
        for part in self._rarely_changed:
            others |= part.refresh()
            values += part.values
        free = []
        for name in ("robot", "custom"):
            if branch := tree[name]:
                free += [join(name, key) for key in branch]
                values += [plain(value) for value in branch.values()]
        if others or free != self._free:
            self._free = free
            self._paths = [*self._here, *(path for part in self._rarely_changed for path in part.paths), *free]
        return self._paths, values

    def _fixed(self) -> Iterator[Leaf]:
        tree = self._tree
        yield from _of(tree["control"])
        # Physics and robots change the supply and the LED; the rest of power and roborio is constant.
        yield from _of(tree["power"], "vin_voltage", "vin_current", "brownout_voltage")
        yield from _of(tree["roborio"], "radio_led_state")
        yield from _of(tree["time"], "remaining")
        yield from _of(tree, "alliance_station", "fpga_button", "user_program_state")

    def _present(self) -> Iterator[Leaf]:
        tree = self._tree
        if tree["accelerometer"]["active"]:
            yield from _of(tree["accelerometer"])
        for kind, channels in self._kinds:
            for index, exists in enumerate(channels):
                if exists():
                    yield from _of(tree[kind.name][index])
        modules = self._modules
        for pneumatics in (modules.pcm_solenoids(), modules.hub_solenoids()):
            for solenoids in pneumatics:
                for solenoid in solenoids:
                    yield from _of(solenoid, "value")
        for branch in (modules.pcm_compressor, modules.ph_compressor, modules.pdp):
            for module in branch.values():
                yield from _of(module)
        for name in sorted(tree["CAN"]):
            yield from _of(tree["CAN"][name])


class _RarelyChanged:
    """Values that rarely change, and are read only when their fingerprint has changed."""

    def __init__(self, fingerprint: Callable[[], object], read: Callable[[], list[tuple[str, Any]]]) -> None:
        self._fingerprint, self._read = fingerprint, read
        self._before: object = None
        self.paths: list[str] = []
        self.values: list[Any] = []

    def refresh(self) -> bool:
        """Update `paths` and `values`; return whether the paths have changed."""
        now = self._fingerprint()
        if now == self._before:
            return False
        self._before = now
        found, before = self._read(), self.paths
        self.paths, self.values = [path for path, _ in found], [value for _, value in found]
        return self.paths != before


class CreatedDevices:
    """The devices that the robot has created, determined without reading each of the hundreds of possible ones.

    The HAL calls back when a device is created, but not when its data are reset, so created devices are checked each
    time.
    """

    def __init__(self, slots: list[Slot]) -> None:
        self._slots = slots
        self._changed = True
        self._watches: list[object] = []
        self._created: list[bool] = []
        self._still_created: list[Callable[[], Any]] = []

    def created(self) -> list[bool]:
        """Return, for each device, whether it was created; the same list object as long as nothing changes."""
        if self._changed or False in [exists() for exists in self._still_created]:
            self._changed = False
            self._watches = [slot.watch(self._note) for slot in self._slots if slot.watch is not None]
            self._created = [bool(slot.get()) for slot in self._slots]
            self._still_created = [
                slot.get for slot, created in zip(self._slots, self._created, strict=True) if created
            ]
        return self._created

    def _note(self) -> None:
        self._changed = True


def _of(place: LiveDict, *keys: str) -> Iterator[Leaf]:
    """Return the given fields of one dict; by default all that cannot be derived from others."""
    for key in keys or [key for key, slot in place._slots.items() if slot.recorded]:
        slot = place._slot(key)
        path = join(place._path, key)
        get = slot.get
        if slot.kind.plain is not None:
            yield path, _plain(get, slot.kind.plain)
        elif isinstance(get(), (LiveDict, list)) or slot.set is None:
            yield path, _plain(get, plain)
        else:
            yield path, get


def _plain(get: Callable[[], Any], convert: Callable[[Any], Any]) -> Callable[[], Any]:
    return lambda: convert(get())


def _stick(stick: driver_station.JoystickData) -> list[tuple[str, Any]]:
    """Return one value for all axes, and one for all buttons: lists that can be written back as a whole."""
    axes, buttons, povs = stick.controls()
    if not (axes or len(buttons) > 1 or povs):
        return []
    path = stick._path
    found: list[tuple[str, Any]] = []
    if axes:
        found.append((f"{path}.axes", axes))
    if len(buttons) > 1:
        found.append((f"{path}.buttons", buttons))
    if povs:
        found.append((f"{path}.povs", povs))
    return found + [(f"{path}.{key}", stick[key]) for key in ("outputs", "left_rumble", "right_rumble")]
