"""The names that are replaced before the robot's modules are imported; here they are spelled as WPILib spells them.

In: a call by robot code, or by a test. Out: what a robot would do, in robot time, for the run of this process
(`active_run`); what the original does where no robot runs. `install` has the table of what is replaced in each season;
WPILib's names are in a package for each season (`season_2026`), with modules of the same names. What is the same in
each season stands once beside them, and takes the names that differ. As in `wpi`, what is asked of this package is the
season's whose WPILib is installed: ``from .patches import wpilib_names``.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from ...season import CURRENT

if TYPE_CHECKING:
    from .season_2026 import hal_notifiers as hal_notifiers
    from .season_2026 import wpilib_names as wpilib_names

#: The modules of each season's package.
_OF_A_SEASON = ("hal_notifiers", "wpilib_names")


def __getattr__(name: str) -> ModuleType:
    if name in _OF_A_SEASON:
        return import_module(f"{__name__}.season_{CURRENT.year}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
