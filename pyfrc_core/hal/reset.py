"""Reset the simulated HAL before a run: of an earlier run in this process, nothing but its inputs is left."""

from __future__ import annotations

from ..wpi import devices
from . import counters, pneumatics, tree
from .created_devices import prepare_reset
from .modules import MODULES
from .paths import join


def forget_inputs() -> None:
    """Reset all sensors and outputs to their initial values."""
    prepare_reset()
    devices.reset_all()
    counters.forget_written_counts()


def forget_what_stays() -> None:
    """Forget power distributions and what the controller has one of, such as an accelerometer.

    In WPILib's simulation, they stay when their objects are gone. They do no harm.
    """
    for number in range(MODULES):
        module = pneumatics.PowerDistribution(number)
        if pneumatics.exists(module):
            prepare_reset()
            pneumatics.reset(module)
    for device in tree().devices():
        if device.number is None and device.kind.exists and tree().can_write(join(device.path, device.kind.exists)):
            device.place[device.kind.exists] = False
