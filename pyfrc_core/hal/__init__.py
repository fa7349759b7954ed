"""`hal_data`: the robot's inputs and outputs as one tree, live over WPILib's simulated HAL.

The only room that names simulated devices. Importing it changes nothing in the HAL.
"""

from functools import cache

from .containers import LiveDict, LiveList
from .data import HalData
from .kinds import Choice
from .paths import format_path, parse_path

__all__ = [
    "Choice",
    "HalData",
    "LiveDict",
    "LiveList",
    "devices_exist",
    "existing_devices",
    "format_path",
    "parse_path",
]


def devices_exist() -> bool:
    """Return whether this process has made any device in the HAL that still exists."""
    return _tree().anything_made()


def existing_devices() -> list[str]:
    """Return the devices that this process has made in the HAL and that still exist, as ``pwm[3]``."""
    return _tree().devices_made()


_tree = cache(HalData)  # it takes longer to make than to ask
