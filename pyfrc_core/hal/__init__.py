"""`hal_data`: the robot's inputs and outputs as one tree, live over WPILib's simulated HAL.

This is the only package that names simulated devices. Importing it does not change the HAL, and imports WPILib only
when the tree is used: the simulator's window needs paths and no tree.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from .containers import LiveDict, LiveList
from .kinds import Choice
from .paths import format_path, parse_path

if TYPE_CHECKING:
    from .data import HalData

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


def __getattr__(name: str) -> Any:
    if name == "HalData":
        from .data import HalData

        return HalData
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def devices_exist() -> bool:
    """Return whether this process has created any device in the HAL that still exists."""
    return _tree().any_exist()


def existing_devices() -> list[str]:
    """Return the devices that this process has created in the HAL and that still exist, such as ``pwm[3]``."""
    return _tree().existing()


@cache  # creating it takes longer than reading it
def _tree() -> HalData:
    from .data import HalData

    return HalData()
