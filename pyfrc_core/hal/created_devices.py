"""The devices that the robot has created, determined without reading each of the hundreds of possible ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from weakref import WeakSet

from .containers import Slot

_all: WeakSet[CreatedDevices] = WeakSet()


class CreatedDevices:
    """The devices that the robot has created.

    The HAL calls back when a device is created, and no longer after a reset of its data: call `prepare_reset` before
    it. Another reset is noticed as long as it has removed a device.
    """

    def __init__(self, slots: list[Slot]) -> None:
        self._slots = slots
        self._changed = True
        self._watches: list[object] = []
        self._created: list[bool] = []
        self._still_created: list[Callable[[], Any]] = []
        _all.add(self)

    def created(self) -> list[bool]:
        """Return, for each device, whether it was created; the same list object as long as nothing changes."""
        if self._changed or False in [still_created() for still_created in self._still_created]:
            self.stop_watching()
            self._changed = False
            self._watches = [slot.watch(self._note) for slot in self._slots if slot.watch is not None]
            self._created = [bool(slot.get()) for slot in self._slots]
            self._still_created = [
                slot.get for slot, created in zip(self._slots, self._created, strict=True) if created
            ]
        return self._created

    def stop_watching(self) -> None:
        """Remove the callbacks from the HAL, until the next call of `created`."""
        self._watches.clear()
        self._changed = True

    def _note(self) -> None:
        self._changed = True


def prepare_reset() -> None:
    """Prepare a reset of the roboRIO's data in the HAL, which removes all callbacks of a device without a sign.

    They are removed before it: afterwards, their numbers are those of other callbacks.
    """
    for devices in list(_all):
        devices.stop_watching()
