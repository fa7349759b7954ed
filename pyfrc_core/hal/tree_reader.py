"""Read every value of `hal_data` that may change during a run, as ``(path, value)`` pairs, for recordings and traces.

A trace reads them at each packet, so that must not take longer the more values there are. The list of values is built
again only after a device was created or removed. `changing_values` finds the changed values of devices; those of
joysticks and of the event are read only after their bytes have changed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

import hal.simulation

from . import driver_station
from .changing_values import ChangingValues, Leaf, same
from .containers import LiveDict, Slot, plain
from .devices import KINDS
from .modules import Modules
from .paths import join
from .sim_device_list import Signature

#: How many versions are kept for readers that do not look at each of them.
_KEPT_VERSIONS = 16


class TreeReader:
    """Reads the values of `HalData.leaves` from a prepared list.

    Attributes:
        paths: the paths at the last `refresh`; the same list until one of them comes or goes
        values: the value of each path
        version: a number that grows with each change of a value or path
    """

    def __init__(self, tree: LiveDict, modules: Modules) -> None:
        self._tree = tree
        self._modules = modules
        self._always = list(self._fixed())
        event = [(leaf.path, leaf.read) for leaf in _of(tree["event"])]
        initialized = [(kind, kind.initialized()) for kind in KINDS]
        self._kinds = [(kind, [slot.get for slot in channels]) for kind, channels in initialized]
        slots = [slot for _, channels in initialized for slot in channels]
        slots += [*modules.initialized(), tree["accelerometer"]._slot("active")]
        self._devices = CreatedDevices(slots)
        self._created: list[bool] = []
        self._signature: Signature | None = None
        self._live = ChangingValues(())
        self._here: list[str] = []
        self._bridged: list[str] = []
        self._parts: list[_Part] = [
            _RarelyChanged(tree["event"].fingerprint, lambda: [(path, get()) for path, get in event]),
            *(_RarelyChanged(stick.fingerprint, partial(_stick, stick)) for stick in tree["joysticks"]),
            _FreeValues("robot", tree["robot"].free()),
            _FreeValues("custom", tree["custom"]),
        ]
        #: Where each part begins in `paths`, and how far the bridged values lie behind their place in `_live`.
        self._begins: list[int] = []
        self._shift = 0
        #: The positions that each of the last versions has changed.
        self._recent: deque[list[int]] = deque(maxlen=_KEPT_VERSIONS)
        self.paths: list[str] = []
        self.values: list[Any] = []
        self.version = 0

    def any_exist(self) -> bool:
        """Return whether any device exists, or any thread of WPILib that waits for an alarm."""
        created = self._devices.any_created() or bool(self._tree["CAN"].signature())
        return created or hal.simulation.getNumNotifiers() > 0

    def existing(self) -> list[str]:
        """Return the devices that exist, such as ``pwm[3]``, and finally whether a WPILib thread waits for an alarm."""
        slots = [join(kind.name, index) for kind in KINDS for index, _ in enumerate(kind.initialized())]
        slots += ["pneumatics or power distribution"] * len(list(self._modules.initialized()))
        slots.append("accelerometer")
        names = [name for name, there in zip(slots, self._devices.created_now(), strict=True) if there]
        if self._tree["CAN"].signature():
            names += [join("CAN", name) for name in sorted(self._tree["CAN"])]
        return names + ["a notifier"] * (hal.simulation.getNumNotifiers() > 0)

    def refresh(self) -> None:
        """Update `paths`, `values` and `version`."""
        devices, created = self._tree["CAN"].signature(), self._devices.created()
        self._tree["robot"].sync(devices)
        moved = devices is not self._signature or created != self._created
        if moved:
            self._signature, self._created = devices, created
            self._find_live()
        changed = [part.refresh() for part in self._parts]
        if moved or _PATHS in changed:
            self._assemble()
            return
        now, values, live = [], self.values, self._live.values
        here, shift = len(self._here), self._shift
        for place in self._live.look():
            position = place if place < here else place + shift
            values[position] = live[place]
            now.append(position)
        if _VALUES in changed:
            for part, begin, change in zip(self._parts, self._begins, changed, strict=True):
                if change == _VALUES:
                    now += self._update(begin, part.values)
            now.sort()
        if now:
            self.version += 1
            self._recent.append(now)

    def changed_since(self, version: int) -> list[int]:
        """Return the positions of values that may have changed since a version with the same `paths`, in order.

        Values that have changed back are among them, and after many versions all values.
        """
        recent, versions = self._recent, self.version - version
        if versions == 1:
            return recent[-1]
        if versions > len(recent):
            return list(range(len(self.values)))
        return sorted(set().union(*(recent[-back] for back in range(1, versions + 1))))

    def _update(self, begin: int, now: list[object]) -> Iterator[int]:
        """Update values from a position on; yield the positions of those that have changed."""
        for position, value in enumerate(now, begin):
            if not same(self.values[position], value):
                self.values[position] = value
                yield position

    def _find_live(self) -> None:
        """Build the list of the devices' values."""
        here = [*self._always, *self._present()]
        bridged = [
            next(_of(device, value))._replace(path=join("robot", key))
            for key, (device, value) in self._tree["robot"].bridged().items()
        ]
        self._live.close()
        self._live = ChangingValues([*here, *bridged])
        self._here, self._bridged = [leaf.path for leaf in here], [leaf.path for leaf in bridged]

    def _assemble(self) -> None:
        """Put all paths and values together."""
        self._live.look()
        here = len(self._here)
        paths, values = [*self._here], self._live.values[:here]
        self._begins.clear()
        for part in self._parts:
            if part is self._parts[-1]:  # `robot` has its free keys first, then the bridged ones
                self._shift = len(paths) - here
                paths += self._bridged
                values += self._live.values[here:]
            self._begins.append(len(paths))
            paths += part.paths
            values += part.values
        self.paths, self.values = paths, values
        self._recent.clear()
        self.version += 1

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
            yield from _of(tree["CAN"].device(name))


#: What a part of the tree finds when it is refreshed: nothing new, other values, or other paths.
_NOTHING, _VALUES, _PATHS = range(3)


class _Part:
    """Some paths of the tree, and their values."""

    def __init__(self) -> None:
        self.paths: list[str] = []
        self.values: list[Any] = []

    def refresh(self) -> int:
        """Update `paths` and `values`; return what has changed."""
        raise NotImplementedError


class _RarelyChanged(_Part):
    """Values that rarely change, and are read only when their fingerprint has changed."""

    def __init__(self, fingerprint: Callable[[], object], read: Callable[[], list[tuple[str, object]]]) -> None:
        super().__init__()
        self._fingerprint, self._read = fingerprint, read
        self._before: object = None

    def refresh(self) -> int:
        now = self._fingerprint()
        if now == self._before:
            return _NOTHING
        self._before = now
        found, before = self._read(), self.paths
        self.paths, self.values = [path for path, _ in found], [value for _, value in found]
        return _VALUES if self.paths == before else _PATHS


class _FreeValues(_Part):
    """The values of free keys, which may be anything."""

    def __init__(self, name: str, source: Mapping[str, object]) -> None:
        super().__init__()
        self._name, self._source = name, source
        self._keys: list[str] = []

    def refresh(self) -> int:
        if not self._source and not self._keys:
            return _NOTHING
        keys, self.values = list(self._source), [plain(value) for value in self._source.values()]
        if keys == self._keys:
            return _VALUES
        self._keys, self.paths = keys, [join(self._name, key) for key in keys]
        return _PATHS


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

    def created_now(self) -> list[bool]:
        """Return the same, also after a reset of the HAL, which ends all watches without a report."""
        self._changed = True
        return self.created()

    def any_created(self) -> bool:
        """Return whether any device was created, also after a reset of the HAL."""
        return any(slot.get() for slot in self._slots)

    def _note(self) -> None:
        self._changed = True


def _of(place: LiveDict, *keys: str) -> Iterator[Leaf]:
    """Return the given fields of one dict; by default all that cannot be derived from others."""
    for key in keys or [key for key, slot in place._slots.items() if slot.recorded]:
        slot = place._slot(key)
        path = join(place._path, key)
        get = slot.get
        if slot.raw is not None:
            yield Leaf(path, slot.raw.read, 0, slot.raw.convert)
        elif slot.kind.plain is not None:
            yield Leaf(path, _plain(get, slot.kind.plain), slot.handle)
        elif isinstance(get(), (LiveDict, list)) or slot.set is None:
            yield Leaf(path, _plain(get, plain), slot.handle)
        else:
            yield Leaf(path, get, slot.handle)


def _plain(get: Callable[[], object], convert: Callable[[object], object]) -> Callable[[], Any]:
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
