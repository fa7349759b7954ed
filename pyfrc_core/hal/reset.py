"""Reset the simulated HAL before a run: of an earlier run in this process, nothing but its inputs is left."""

from __future__ import annotations

from ..wpi import devices
from . import counters, pneumatics, tree
from .created_devices import prepare_reset
from .modules import MODULES


def forget_inputs() -> None:
    """Reset all sensors and outputs to their initial values."""
    prepare_reset()
    devices.reset_all()
    counters.forget_written_counts()


def forget_what_stays() -> None:
    """Forget power distributions and the accelerometer: in WPILib's simulation, they stay when their objects are gone.

    They do no harm.
    """
    for number in range(MODULES):
        module = pneumatics.PowerDistribution(number)
        if pneumatics.exists(module):
            prepare_reset()
            pneumatics.reset(module)
    if "accelerometer" in (data := tree()):
        data["accelerometer"]["active"] = False
