"""Read every value of `hal_data` that may change during a run, as ``(path, value)`` pairs, for recordings and traces.

A trace reads them at each packet, so that must not take longer the more values there are. The list of values is built
again only after a device was created or removed. `changing_values` finds the changed values of devices, `tree_parts`
those of joysticks, of the match and of free keys.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import hal.simulation

from ..compat.hal_callbacks import resets
from .changing_values import ChangingValues, Leaf, same
from .containers import LiveDict, plain
from .created_devices import CreatedDevices
from .devices import KINDS
from .driver_station import JoystickData
from .modules import Modules
from .paths import join
from .sim_device_list import Signature
from .tree_parts import PATHS, FreeValues, Part, Parts, RarelyChanged

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
        self._can, self._robot = tree["CAN"], tree["robot"]
        self._modules = modules
        self._always = list(self._fixed())
        event = [(leaf.path, leaf.read) for leaf in _of(tree["event"])]
        initialized = [(kind, kind.initialized()) for kind in KINDS]
        self._kinds = [(kind, [slot.get for slot in channels]) for kind, channels in initialized]
        slots = [slot for _, channels in initialized for slot in channels]
        slots += [*modules.initialized(), tree["accelerometer"]._slot("active")]
        self._devices = CreatedDevices(slots)
        controls = [(stick, RarelyChanged(stick, partial(_controls, stick))) for stick in tree["joysticks"]]
        sent_back = _SentBack(controls)
        self._created: list[bool] = []
        self._signature: Signature | None = None
        #: How many resets were announced before the HAL's reports were registered.
        self._resets = 0
        self._live = ChangingValues(())
        self._live_paths: list[str] = []
        self._parts = Parts(
            RarelyChanged(tree["event"], lambda: [(path, get()) for path, get in event]),
            *(part for _, part in controls),
            RarelyChanged(sent_back, sent_back.read),
            FreeValues("robot", self._robot.free()),
            FreeValues("custom", tree["custom"]),
        )
        #: The positions that each of the last versions has changed.
        self._recent: deque[list[int]] = deque(maxlen=_KEPT_VERSIONS)
        self.paths: list[str] = []
        self.values: list[Any] = []
        self.version = 0

    def any_exist(self) -> bool:
        """Return whether any device exists, or any thread of WPILib that waits for an alarm."""
        created = self._devices.any_created() or bool(self._can.signature())
        return created or hal.simulation.getNumNotifiers() > 0

    def existing(self) -> list[str]:
        """Return the devices that exist, such as ``pwm[3]``, and finally whether a WPILib thread waits for an alarm."""
        slots = [join(kind.name, index) for kind in KINDS for index, _ in enumerate(kind.initialized())]
        slots += ["pneumatics or power distribution"] * len(list(self._modules.initialized()))
        slots.append("accelerometer")
        names = [name for name, there in zip(slots, self._devices.created_now(), strict=True) if there]
        if self._can.signature():
            names += [join("CAN", name) for name in sorted(self._can)]
        return names + ["a notifier"] * (hal.simulation.getNumNotifiers() > 0)

    def refresh(self) -> None:
        """Update `paths`, `values` and `version`."""
        devices, created = self._can.signature(), self._devices.created()
        self._robot.sync(devices)
        if devices is not self._signature or created is not self._created or self._resets != resets.number:
            self._signature, self._created, self._resets = devices, created, resets.number
            self._register()
            return
        now = self._live.look(self.values)
        change, parts = self._parts.refresh()
        if change == PATHS:
            self._assemble(self.values[: len(self._live_paths)])
            return
        for part in parts:
            now += self._update(part)
        if now:
            if parts:
                now.sort()
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

    def _update(self, part: Part) -> Iterator[int]:
        """Update the values of a part; yield the positions of those that have changed."""
        for position, value in enumerate(part.values, part.begin):
            if not same(self.values[position], value):
                self.values[position] = value
                yield position

    def _register(self) -> None:
        """List the devices' values, and have the HAL report their changes."""
        leaves = [*self._always, *self._present(), *self._bridged()]
        self._live.close()
        self._live = ChangingValues(leaves, [handle for _, handle, _ in self._signature or ()])
        self._live_paths = [leaf.path for leaf in leaves]
        self._parts.register()
        self._assemble(self._live.values)

    def _assemble(self, values: list[Any]) -> None:
        """Put all paths and values together.

        :param values: the devices' values
        """
        paths, values = [*self._live_paths], [*values]
        for part in self._parts.all:
            part.begin = len(paths)
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
        for name in sorted(self._can):
            yield from _of(self._can.device(name))

    def _bridged(self) -> Iterator[Leaf]:
        for key, (device, value) in self._robot.bridged().items():
            yield next(_of(device, value))._replace(path=join("robot", key))


def _of(place: LiveDict, *keys: str) -> Iterator[Leaf]:
    """Return the given fields of one dict; by default all that cannot be derived from others."""
    for key in keys or [key for key, slot in place._slots.items() if slot.recorded]:
        slot = place._slot(key)
        path = join(place._path, key)
        get = slot.get
        if slot.raw is not None:
            yield Leaf(path, slot.raw.read, slot.reports, slot.raw.convert)
        elif slot.kind.plain is not None:
            yield Leaf(path, _plain(get, slot.kind.plain), slot.reports)
        elif isinstance(get(), (LiveDict, list)) or slot.set is None:
            yield Leaf(path, _plain(get, plain), slot.reports)
        else:
            yield Leaf(path, get, slot.reports)


def _plain(get: Callable[[], object], convert: Callable[[object], object]) -> Callable[[], Any]:
    return lambda: convert(get())


def _controls(stick: JoystickData) -> list[tuple[str, Any]]:
    """Return one value for all axes, and one for all buttons: lists that can be written back as a whole."""
    axes, buttons, povs = stick.controls()
    path = stick._path
    found: list[tuple[str, Any]] = []
    if axes:
        found.append((f"{path}.axes", axes))
    if len(buttons) > 1:
        found.append((f"{path}.buttons", buttons))
    if povs:
        found.append((f"{path}.povs", povs))
    return found


class _SentBack:
    """What the robot sends to the joysticks that are plugged in: robots often set it in each packet.

    :param controls: the joysticks, each with the part of its controls, which has paths when it is plugged in and is
        refreshed before this
    """

    reports = (*JoystickData.reports, *JoystickData.output_reports)

    def __init__(self, controls: Sequence[tuple[JoystickData, Part]]) -> None:
        self._controls = controls

    def fingerprint(self) -> object:
        return [stick.outputs() for stick, part in self._controls if part.paths]

    def read(self) -> list[tuple[str, Any]]:
        keys = ("outputs", "left_rumble", "right_rumble")
        return [
            (f"{stick._path}.{key}", value)
            for stick, part in self._controls
            if part.paths
            for key, value in zip(keys, stick.outputs(), strict=True)
        ]
