"""Devices of the simulated HAL, and what WPILib waits for in it."""

from __future__ import annotations

from collections.abc import Iterator

from ...hal import existing_devices
from ...hal.reset import forget_inputs, forget_what_stays
from ...wpi import sim_devices
from .part import Part


class Devices(Part):
    """The devices: each ends with the object that has made it."""

    def __init__(self) -> None:
        self._before = existing_devices()

    def restore(self) -> None:
        forget_what_stays()
        sim_devices.forget_parts()

    def left_over(self) -> Iterator[str]:
        left = [device for device in existing_devices() if device not in self._before]
        yield from (f"the device {device}" for device in left)
        if not left:
            forget_inputs()
