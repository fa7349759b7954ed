"""Reset the simulated HAL before a run: of an earlier run in this process, nothing but its inputs is left."""

from __future__ import annotations

from hal.simulation import resetAllSimData

from .counters import forget_written_counts
from .created_devices import prepare_reset


def forget_inputs() -> None:
    """Reset all sensors and outputs to their initial values."""
    prepare_reset()
    resetAllSimData()
    forget_written_counts()
