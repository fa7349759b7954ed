"""The devices that the robot has created, determined without reading each of the hundreds of possible ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..compat.hal_callbacks import resets
from .containers import Slot


class CreatedDevices:
    """The devices that the robot has created.

    The HAL calls back when a device is created. When its data are reset, it does not: unless resets are announced,
    created devices are therefore checked each time.
    """

    def __init__(self, slots: list[Slot]) -> None:
        self._slots = slots
        self._changed = True
        self._resets = 0
        self._watches: list[object] = []
        self._created: list[bool] = []
        self._still_created: list[Callable[[], Any]] = []

    def created(self) -> list[bool]:
        """Return, for each device, whether it was created; the same list object as long as nothing changes."""
        if self._changed or self._reset():
            self._changed, self._resets = False, resets.number
            self._watches = [slot.watch(self._note) for slot in self._slots if slot.watch is not None]
            self._created = [bool(slot.get()) for slot in self._slots]
            self._still_created = [
                slot.get for slot, created in zip(self._slots, self._created, strict=True) if created
            ]
        return self._created

    def _reset(self) -> bool:
        """Return whether a device may have been reset."""
        if resets.announced:
            return self._resets != resets.number
        return False in [exists() for exists in self._still_created]

    def created_now(self) -> list[bool]:
        """Return the same, also after a reset of the HAL, which ends all watches without a report."""
        self._changed = True
        return self.created()

    def any_created(self) -> bool:
        """Return whether any device was created, also after a reset of the HAL."""
        return any(slot.get() for slot in self._slots)

    def _note(self) -> None:
        self._changed = True
