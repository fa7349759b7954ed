"""`hal_data`: the robot's inputs and outputs as one tree, live over WPILib's simulated HAL.

In: the HAL of this process. Out: `HalData`, dicts and lists that read and write the HAL itself. They store no value
that the HAL has, so no two users of a run can see different values. Paths into it, such as ``joysticks[0].axes[1]``,
are also the language of input scripts and traces (`paths`).

Each device is a row of a table (`device_table`), which says what its values are: recordings, restarts, comparison, fuzz
and the simulator ask the row of a path (`rows`), which needs no WPILib.

Traces and recordings find what has changed by one mechanism: `tree_reader` reads every value of the devices that exist
through WPILib's bindings, and `change_reader` compares. Which of the roboRIO's 290 possible devices exist, the HAL
reports (`created_devices`). It reports no SimDevices to Python, so these are listed at each look (`sim_device_list`).

A season's devices, and how WPILib spells them, are in a package of their own (`season_2026`). As in `wpi`, another
season is a package beside it with modules of the same names, and what is asked of this package is the season's whose
WPILib is installed: ``from ..hal import device_table``.

Importing this package does not change the HAL, and imports WPILib only when the tree is used: the simulator's window
needs paths and no tree.

Where the simulated HAL differs from the hardware, this room does what the hardware does: outputs are off while the
robot is disabled (`output_gate`).
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..season import CURRENT
from .containers import LiveDict, LiveList
from .kinds import Choice
from .paths import format_path, parse_path

if TYPE_CHECKING:
    from .data import HalData
    from .season_2026 import accessors as accessors
    from .season_2026 import counters as counters
    from .season_2026 import device_table as device_table
    from .season_2026 import driver_station as driver_station
    from .season_2026 import pneumatics as pneumatics

#: The modules of each season's package.
_OF_A_SEASON = ("accessors", "counters", "device_table", "driver_station", "pneumatics")

#: Among `existing_devices`: all notifiers, which have no numbers.
NOTIFIER = "a notifier"

__all__ = [
    "NOTIFIER",
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
    if name in _OF_A_SEASON:
        return import_module(f"{__name__}.season_{CURRENT.year}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def devices_exist() -> bool:
    """Return whether this process has created any device in the HAL that still exists."""
    return tree().any_exist()


def existing_devices() -> list[str]:
    """Return the devices that this process has created in the HAL and that still exist, such as ``pwm[3]``."""
    return tree().existing()


@cache  # creating it takes longer than reading it
def tree() -> HalData:
    """Return the tree of this process."""
    from .data import HalData

    return HalData()
