"""Devices that a vendor's library simulates in real time, on threads of its own: their values do not repeat.

Known is CTRE's phoenix6 (26.3): its clock is the computer's, it does not follow WPILib's stepped time, and its devices
answer some milliseconds later. ``docs/vendors.md`` has the measurements. Its simulated devices have names such as
``CANMotor:Talon FX (v6)[11]`` and ``CANEncoder:Talon FX (v6)[11]/Rotor Sensor``.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Sequence

from ..wording import counted

#: The vendors' modules, and patterns for the names of their SimDevices: the kind and the number of a device.
_LIBRARIES = {"phoenix6": re.compile(r"CAN\w*:([^/\[\]]+?) \(v6\)\[(\d+)\]")}

#: The number of devices that a sentence names.
_NAMED = 2


def real_time_libraries() -> tuple[str, ...]:
    """Return the libraries of this kind that are imported in this process."""
    return tuple(module for module in _LIBRARIES if module in sys.modules)


def is_real_time(name: str) -> bool:
    """Return whether a SimDevice, given by its name or by a path into `hal_data`, is simulated in real time."""
    return any(_LIBRARIES[module].search(name) for module in real_time_libraries())


def real_time_devices(names: Iterable[str]) -> tuple[str, ...]:
    """Return the devices that are simulated in real time among SimDevices, such as ``phoenix6 Talon FX 11``."""
    found = set()
    for module in real_time_libraries():
        for name in names:
            if match := _LIBRARIES[module].match(name):
                found.add((module, match[1], int(match[2])))
    return tuple(f"{module} {kind} {number}" for module, kind, number in sorted(found))


def explain_real_time(devices: Sequence[str]) -> str:
    """Return one sentence that names devices of `real_time_devices`, the reason and what to do."""
    library = devices[0].split(" ", 1)[0]
    names = [device.split(" ", 1)[1] for device in devices]
    rest = [counted(len(names) - _NAMED, "more device")] if len(names) > _NAMED else []
    *first, last = names[:_NAMED] + rest
    listed = f"{', '.join(first)} and {last}" if first else last
    verb, them, their = ("does", "it", "its") if len(names) == 1 else ("do", "them", "their")
    return (
        f"{listed} {verb} not repeat exactly, because {library} simulates {them} in real time: a trace's hash leaves "
        f"out {their} values, and tests should compare what depends on {them} with a tolerance."
    )
