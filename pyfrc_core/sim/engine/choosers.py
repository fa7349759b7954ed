"""The choosers that a robot has published, in its values of NetworkTables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .messages import VALUE
from .snapshot import Chooser

#: The types of WPILib's choosers; the second is that of 2027.
_TYPES = ("String Chooser", "Selectable")
#: Where the option is that the robot uses, in one of these tables.
_ACTIVE = ("active", "selected/value")


def chooser_at(values: Mapping[str, Any], table: str) -> Chooser | None:
    """Return the chooser of a table, such as ``/SmartDashboard/Auto``; None if it has none.

    :param values: those of the robot, by path
    """
    path = VALUE + table
    options = values.get(f"{path}/options")
    if values.get(f"{path}/.type") not in _TYPES or not isinstance(options, (list, tuple)):
        return None
    default = str(values.get(f"{path}/default", ""))
    active = next((found for name in _ACTIVE if (found := values.get(f"{path}/{name}"))), default)
    return Chooser(table, tuple(map(str, options)), default, str(active))
