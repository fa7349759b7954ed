"""What a robot's run is recorded from: each value that may change, as ``(path, value)`` pairs.

The list of what to read is made anew only when something was made or unmade, and the values of joysticks and of the
event only when their bytes have changed: a trace is taken at each packet.
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


class Recording:
    """The compiled list of what `HalData.leaves` yields.

    :param tree: the root of the tree
    :param modules: the pneumatics and power distribution modules in it
    """

    def __init__(self, tree: LiveDict, modules: Modules) -> None:
        self._tree = tree
        self._modules = modules
        self._always = list(self._fixed())
        event = list(_of(tree["event"]))
        self._at_rest = [
            _AtRest(tree["event"].fingerprint, lambda: [(path, get()) for path, get in event]),
            *(_AtRest(stick.fingerprint, partial(_stick, stick)) for stick in tree["joysticks"]),
        ]
        self._kinds = [(kind, [slot.get for slot in kind.initialized()]) for kind in KINDS]
        slots = [slot for kind in KINDS for slot in kind.initialized()]
        slots += [*modules.initialized(), tree["accelerometer"]._slot("active")]
        self._devices = MadeDevices(slots)
        self._state: Any = None
        self._here: list[str] = []
        self._reads: list[Callable[[], Any]] = []
        self._free: list[str] = []
        self._paths: list[str] = []

    def anything_made(self) -> bool:
        """Return whether any device exists, or any thread of WPILib's that waits for an alarm."""
        made = any(self._devices.made()) or bool(self._tree["CAN"].signature())
        return made or hal.simulation.getNumNotifiers() > 0

    def devices_made(self) -> list[str]:
        """Return the devices that exist, as ``pwm[3]``, and last whether a thread of WPILib's waits for an alarm."""
        slots = [join(kind.name, index) for kind in KINDS for index, _ in enumerate(kind.initialized())]
        slots += ["pneumatics or power distribution"] * len(list(self._modules.initialized()))
        slots.append("accelerometer")
        made = [name for name, there in zip(slots, self._devices.made(), strict=True) if there]
        if self._tree["CAN"].signature():
            made += [join("CAN", name) for name in sorted(self._tree["CAN"])]
        return made + ["a notifier"] * (hal.simulation.getNumNotifiers() > 0)

    def look(self) -> tuple[list[str], list[Any]]:
        """The paths, the same list while it is the same paths, and the value of each."""
        tree = self._tree
        devices = tree["CAN"].signature()
        tree["robot"].sync(devices)
        state = (self._devices.made(), devices)
        others = state != self._state
        if others:
            self._state = state
            leaves = [*self._always, *self._present()]
            self._here, self._reads = [path for path, _ in leaves], [read for _, read in leaves]
        values = [read() for read in self._reads]
        for part in self._at_rest:
            others |= part.look()
            values += part.values
        free = []
        for name in ("robot", "custom"):
            if room := tree[name]:
                free += [join(name, key) for key in room]
                values += [plain(value) for value in room.values()]
        if others or free != self._free:
            self._free = free
            self._paths = [*self._here, *(path for part in self._at_rest for path in part.paths), *free]
        return self._paths, values

    def _fixed(self) -> Iterator[Leaf]:
        tree = self._tree
        yield from _of(tree["control"])
        # Supply and LED are what physics and robots touch; the rest of power and roborio stands still.
        yield from _of(tree["power"], "vin_voltage", "vin_current", "brownout_voltage")
        yield from _of(tree["roborio"], "radio_led_state")
        yield from _of(tree["time"], "remaining")
        yield from _of(tree, "alliance_station", "fpga_button", "user_program_state")

    def _present(self) -> Iterator[Leaf]:
        tree = self._tree
        if tree["accelerometer"]["active"]:
            yield from _of(tree["accelerometer"])
        for kind, channels in self._kinds:
            for index, tells in enumerate(channels):
                if tells():
                    yield from _of(tree[kind.name][index])
        modules = self._modules
        for pneumatics in (modules.pcm_solenoids(), modules.hub_solenoids()):
            for solenoids in pneumatics:
                for solenoid in solenoids:
                    yield from _of(solenoid, "value")
        for room in (modules.pcm_compressor, modules.ph_compressor, modules.pdp):
            for module in room.values():
                yield from _of(module)
        for name in sorted(tree["CAN"]):
            yield from _of(tree["CAN"][name])


class _AtRest:
    """What mostly stays as it is, and is read only when its fingerprint has changed."""

    def __init__(self, fingerprint: Callable[[], object], read: Callable[[], list[tuple[str, Any]]]) -> None:
        self._fingerprint, self._read = fingerprint, read
        self._before: object = None
        self.paths: list[str] = []
        self.values: list[Any] = []

    def look(self) -> bool:
        """Bring `paths` and `values` up to date; answers whether the paths are others."""
        now = self._fingerprint()
        if now == self._before:
            return False
        self._before = now
        found, before = self._read(), self.paths
        self.paths, self.values = [path for path, _ in found], [value for _, value in found]
        return self.paths != before


class MadeDevices:
    """Which devices the robot has made, without reading each of the hundreds that it could make.

    The HAL calls back when one is made, but not when a device's data are reset: so those that were made are read again.
    """

    def __init__(self, slots: list[Slot]) -> None:
        self._slots = slots
        self._noted = True
        self._watches: list[object] = []
        self._made: list[bool] = []
        self._still_made: list[Callable[[], Any]] = []

    def made(self) -> list[bool]:
        """Return, for each device, whether it has been made; the same list object as long as nothing changes."""
        if self._noted or False in [is_made() for is_made in self._still_made]:
            self._noted = False
            self._watches = [slot.watch(self._note) for slot in self._slots if slot.watch is not None]
            self._made = [bool(slot.get()) for slot in self._slots]
            self._still_made = [slot.get for slot, made in zip(self._slots, self._made, strict=True) if made]
        return self._made

    def _note(self) -> None:
        self._noted = True


def _of(place: LiveDict, *keys: str) -> Iterator[Leaf]:
    """The fields of one dict, all that tell something of their own if none is named."""
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


def _stick(stick: driver_station.Joystick) -> list[tuple[str, Any]]:
    """One value for all axes, one for all buttons: lists that can be written back whole."""
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
