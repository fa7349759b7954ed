"""What a robot's run is recorded from: each value that may change, as ``(path, value)`` pairs.

The list of what to read is made anew only when something was made or unmade; finding that out is a call for
every channel there may be, which costs less than reading them and cannot miss a reset as the HAL's notices
would.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import hal.simulation

from . import driver_station
from .containers import LiveDict, plain
from .devices import KINDS
from .paths import join

if TYPE_CHECKING:
    from .data import HalData

Leaf = tuple[str, Callable[[], Any]]


class Recording:
    """The compiled list of `HalData.leaves`."""

    def __init__(self, tree: HalData) -> None:
        self._tree = tree
        self._always = list(self._fixed())
        self._kinds = [(kind, kind.initialized()) for kind in KINDS]
        self._polled = [tells for _, channels in self._kinds for tells in channels]
        self._polled += tree.modules.initialized()
        self._polled.append(tree["accelerometer"]._slot("active").get)
        self._sticks = [stick.counts for stick in tree["joysticks"]]
        self._state: Any = None
        self._leaves: list[Leaf] = []

    def anything_made(self) -> bool:
        """Whether any device exists, or any thread of WPILib's that waits for an alarm."""
        made = any(tells() for tells in self._polled) or bool(self._tree["CAN"].signature())
        return made or hal.simulation.getNumNotifiers() > 0

    def leaves(self) -> Iterator[tuple[str, Any]]:
        tree = self._tree
        devices = tree["CAN"].signature()
        tree["robot"].sync(devices)
        state = ([tells() for tells in self._polled], [counts() for counts in self._sticks], devices)
        if state != self._state:
            self._leaves = [*self._always, *self._present()]
            self._state = state
        found = [(path, get()) for path, get in self._leaves]
        for room in ("robot", "custom"):
            found += [(join(room, key), plain(value)) for key, value in tree[room].items()]
        return iter(found)

    def _fixed(self) -> Iterator[Leaf]:
        tree = self._tree
        for room in ("control", "event"):
            yield from _of(tree[room])
        # Supply and LED are what physics and robots touch; the rest of power and roborio stands still.
        yield from _of(tree["power"], "vin_voltage", "vin_current", "brownout_voltage")
        yield from _of(tree["roborio"], "radio_led_state")
        yield from _of(tree["time"], "remaining")
        yield from _of(tree, "alliance_station", "fpga_button", "user_program_state")

    def _present(self) -> Iterator[Leaf]:
        tree = self._tree
        for stick in tree["joysticks"]:
            yield from _stick(stick)
        if tree["accelerometer"]["active"]:
            yield from _of(tree["accelerometer"])
        for kind, channels in self._kinds:
            for index, tells in enumerate(channels):
                if tells():
                    yield from _of(tree[kind.name][index])
        modules = tree.modules
        for pneumatics in (modules.pcm_solenoids(), modules.hub_solenoids()):
            for solenoids in pneumatics:
                for solenoid in solenoids:
                    yield from _of(solenoid, "value")
        for room in (modules.pcm_compressor, modules.ph_compressor, modules.pdp):
            for module in room.values():
                yield from _of(module)
        for name in sorted(tree["CAN"]):
            yield from _of(tree["CAN"][name])


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


def _stick(stick: driver_station.Joystick) -> Iterator[Leaf]:
    """One value for all axes, one for all buttons: lists that can be written back whole."""
    axes, buttons, povs = stick.counts()
    path = stick._path
    if axes:
        yield join(path, "axes"), lambda: stick._load_axes()[:axes]
    if buttons:
        yield join(path, "buttons"), lambda: stick._load_buttons()[: buttons + 1]
    if povs:
        yield join(path, "povs"), lambda: stick._load_povs()[:povs]
    if axes or buttons or povs:
        yield from _of(stick, "outputs", "left_rumble", "right_rumble")
