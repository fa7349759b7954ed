"""Which devices of `hal_data` exist: those of the roboRIO, the modules on the CAN bus, and SimDevices."""

from __future__ import annotations

from collections.abc import Iterator

from ..wpi import timing
from . import device_table
from .containers import LiveDict
from .created_devices import CreatedDevices
from .modules import Modules
from .paths import join
from .sim_devices import SimDevices


class RobotDevices:
    """The devices of one tree.

    :param tree: `HalData`
    :param modules: its modules on the CAN bus
    """

    def __init__(self, tree: LiveDict, modules: Modules) -> None:
        self._can: SimDevices = tree["CAN"]
        channels = [
            (kind.name, index, slot) for kind in device_table.KINDS for index, slot in enumerate(kind.initialized())
        ]
        module_slots = list(modules.initialized())
        self._channels = [(kind, index) for kind, index, _ in channels]
        self._names = [join(kind, index) for kind, index in self._channels]
        self._names += ["pneumatics or power distribution"] * len(module_slots)
        self._names += device_table.MAY_EXIST
        self._slots = [*(slot for _, _, slot in channels), *module_slots]
        self._slots += [tree[name]._slot(key) for name, key in device_table.MAY_EXIST.items()]
        self._devices = CreatedDevices(self._slots)

    def created(self) -> list[bool]:
        """Return, for each that is no SimDevice, whether it exists; the same list object as long as nothing changes."""
        return self._devices.created()

    def channels(self) -> Iterator[tuple[str, int]]:
        """Return the kind and the index of each device of the roboRIO, as of the last call of `created`."""
        return (channel for channel, exists in zip(self._channels, self.created(), strict=False) if exists)

    def any_exist(self) -> bool:
        """Return whether any device exists, or any thread of WPILib that waits for an alarm."""
        created = any(slot.get() for slot in self._slots) or bool(self._can.signature())
        return created or timing.count_notifiers() > 0

    def existing(self) -> list[str]:
        """Return the devices that exist, such as ``pwm[3]``, and finally whether a WPILib thread waits for an alarm."""
        names = [name for name, slot in zip(self._names, self._slots, strict=True) if slot.get()]
        if self._can.signature():
            names += [join("CAN", name) for name in sorted(self._can)]
        return names + ["a notifier"] * (timing.count_notifiers() > 0)
