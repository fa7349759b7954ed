"""Which devices of `hal_data` exist: those of the controller, the modules on the CAN bus, and SimDevices."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from ..wpi import timing
from . import NOTIFIER, device_table
from .containers import LiveDict, Slot
from .created_devices import CreatedDevices
from .fields import DeviceKind
from .modules import Modules
from .paths import join
from .sim_devices import SimDevices


class TreeDevice(NamedTuple):
    """A device in a tree.

    :param number: None, if there is only one
    :param place: its part of the tree; of a pneumatics module, the list of its solenoids
    """

    kind: DeviceKind
    number: int | None
    place: Any

    @property
    def path(self) -> str:
        """Its path in `hal_data`; empty for the values of the root."""
        return self.kind.name if self.number is None else join(self.kind.name, self.number)


class RobotDevices:
    """The devices of one tree.

    :param tree: `HalData`
    :param modules: its modules on the CAN bus
    """

    def __init__(self, tree: LiveDict, modules: Modules) -> None:
        self._can: SimDevices = tree["CAN"]
        self._modules = modules
        self._by_number = [kind for kind in device_table.KINDS if kind.by_number]
        self._always: list[TreeDevice] = []
        #: Other devices of the controller, and a slot for each that says whether it exists.
        self._own: list[TreeDevice] = []
        self._slots: list[Slot] = []
        for kind in device_table.KINDS:
            if not kind.exists and kind.build is None:
                self._always.append(TreeDevice(kind, None, tree[kind.name] if kind.name else tree))
            for number, slot in enumerate(kind.initialized()):
                numbered = kind.count is not None
                place = tree[kind.name][number] if numbered else tree[kind.name]
                self._own.append(TreeDevice(kind, number if numbered else None, place))
                self._slots.append(slot)
        self._names = [device.path for device in self._own]
        module_slots = list(modules.initialized())
        self._names += ["pneumatics or power distribution"] * len(module_slots)
        self._slots += module_slots
        self._devices = CreatedDevices(self._slots)

    def created(self) -> list[bool]:
        """Return, for each that is no SimDevice, whether it exists; the same list object as long as nothing changes."""
        return self._devices.created()

    def always(self) -> list[TreeDevice]:
        """Return the devices that exist without the robot."""
        return self._always

    def made(self) -> Iterator[TreeDevice]:
        """Return the devices that the robot has made, as of the last call of `created`; no SimDevices."""
        yield from (device for device, exists in zip(self._own, self.created(), strict=False) if exists)
        for kind in self._by_number:
            yield from (TreeDevice(kind, number, place) for number, place in self._modules.made(kind.name))

    def any_exist(self) -> bool:
        """Return whether any device exists, or any thread of WPILib that waits for an alarm."""
        created = any(slot.get() for slot in self._slots) or bool(self._can.signature())
        return created or timing.count_notifiers() > 0

    def existing(self) -> list[str]:
        """Return the devices that exist, such as ``pwm[3]``, and finally whether a WPILib thread waits for an alarm."""
        names = [name for name, slot in zip(self._names, self._slots, strict=True) if slot.get()]
        if self._can.signature():
            names += [join("CAN", name) for name in sorted(self._can)]
        return names + [NOTIFIER] * (timing.count_notifiers() > 0)
