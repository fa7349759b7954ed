"""Reset the simulated HAL before a run: of an earlier run in this process, nothing but its inputs is left."""

from __future__ import annotations

from ..wpi import devices
from . import counters
from .created_devices import prepare_reset


def forget_inputs() -> None:
    """Reset all sensors and outputs to their initial values."""
    prepare_reset()
    devices.reset_all()
    counters.forget_written_counts()
