"""The choosers that a robot has published, in NetworkTables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from .messages import VALUE
from .snapshot import Chooser

#: The types of WPILib's choosers; the second is that of 2027.
_TYPES = ("String Chooser", "Selectable")
#: Where the option is that the robot uses, in one of these tables.
_ACTIVE = ("active", "selected/value")
#: Where the type of a table is.
TABLE_TYPE = "/.type"


def chooser_at(value_of: Callable[[str], Any], table: str) -> Chooser | None:
    """Return the chooser of a table, such as ``/SmartDashboard/Auto``; None if it has none.

    :param value_of: returns the value of an entry; None: it has none
    """
    options = value_of(f"{table}/options")
    if value_of(table + TABLE_TYPE) not in _TYPES or not isinstance(options, (list, tuple)):
        return None
    default = str(value_of(f"{table}/default") or "")
    active = next((found for name in _ACTIVE if (found := value_of(f"{table}/{name}"))), default)
    return Chooser(table, tuple(map(str, options)), default, str(active))


def choosers_in(values: Mapping[str, Any]) -> Iterator[Chooser]:
    """Yield the choosers among a robot's values, by path."""
    for path in values:
        if path.endswith(TABLE_TYPE) and path.startswith(VALUE):
            table = path.removeprefix(VALUE).removesuffix(TABLE_TYPE)
            if (found := chooser_at(lambda name: values.get(VALUE + name), table)) is not None:
                yield found
