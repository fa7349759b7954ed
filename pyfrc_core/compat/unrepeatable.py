"""What a library simulates differently in each run: these values do not repeat.

In real time: CTRE's phoenix6 (26.3) simulates on threads of its own. Its clock is the computer's, it does not follow
WPILib's stepped time, and its devices answer some milliseconds later. The measurements are in
``docs/explanation/determinism.md``.

With noise: REV's `SparkSim.iterate` (2026.0) and WPILib's mechanisms with `measurementStdDevs` draw it from generators
that start by chance and that nothing can seed. `runtime.patches.noise` reports here what has drawn some.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from ..wording import counted

#: The libraries that simulate in real time.
_REAL_TIME = ("phoenix6",)

#: Patterns for the names of libraries' SimDevices: the kind and the number of a device. A device has several, such as
#: ``CANMotor:Talon FX (v6)[11]`` and ``CANEncoder:Talon FX (v6)[11]/Rotor Sensor``.
_DEVICES = {
    "phoenix6": re.compile(r"CAN\w*:([^/\[\]]+?) \(v6\)\[(\d+)\]"),
    "rev": re.compile(r"(SPARK (?:MAX|Flex)) \[(?:\d+,)?(\d+)\]"),
}

#: For each library, why its devices do not repeat, and what to do.
_TOLERANCE = (
    "a trace's hash leaves out {their} values, and tests should compare what depends on {them} with a tolerance"
)
_REASONS = {
    "phoenix6": ("phoenix6 simulates {them} in real time", _TOLERANCE),
    "rev": ("REV's library draws the noise of {their} velocities by chance", _TOLERANCE),
    "wpilib": (
        "WPILib draws the noise of {their} measurementStdDevs by chance",
        "leave measurementStdDevs out in tests, and add noise with random.gauss",
    ),
}

#: The number of devices that a sentence names.
_NAMED = 2

#: Whether SPARKs have drawn noise in this run, and the kinds of mechanisms that draw some.
_noisy_libraries: set[str] = set()
_noisy_mechanisms: set[str] = set()


def real_time_libraries() -> tuple[str, ...]:
    """Return the libraries that simulate in real time and are imported in this process."""
    return tuple(module for module in _REAL_TIME if module in sys.modules)


def unrepeatable_libraries() -> tuple[str, ...]:
    """Return the libraries whose devices do not repeat in this run."""
    return (*real_time_libraries(), *_noisy_libraries)


def report_noise(library: str) -> None:
    """Note that a library's devices draw noise in this run."""
    _noisy_libraries.add(library)


def report_noisy_mechanism(kind: str) -> None:
    """Note that robot code has made a mechanism of this kind that draws noise."""
    _noisy_mechanisms.add(kind)


def forget_noise() -> None:
    """Begin a run: its devices have drawn none yet. Mechanisms may have been made before, by the import of a module."""
    _noisy_libraries.clear()


def forget_all_noise() -> None:
    """Forget mechanisms, too: the modules that have made them are imported again."""
    forget_noise()
    _noisy_mechanisms.clear()


def is_unrepeatable(name: str) -> bool:
    """Return whether a SimDevice, given by its name or by a path into `hal_data`, has values that do not repeat."""
    return any(_DEVICES[module].search(name) for module in unrepeatable_libraries())


def is_real_time(name: str) -> bool:
    """Return whether a SimDevice, given in the same way, is simulated in real time."""
    return any(_DEVICES[module].search(name) for module in real_time_libraries())


def in_real_time(name: str) -> bool:
    """Return whether a path into `hal_data` is of a device that is always simulated in real time."""
    return any(_DEVICES[module].search(name) for module in _REAL_TIME)


def real_time_device(name: str) -> str | None:
    """Return such a device, such as ``Talon FX 11``; None for others."""
    found = next((match for module in _REAL_TIME if (match := _DEVICES[module].search(name))), None)
    return None if found is None else f"{found[1]} {found[2]}"


def may_not_repeat(name: str) -> bool:
    """Return whether a path into `hal_data` is of a device that does not repeat in some runs."""
    return any(pattern.search(name) for pattern in _DEVICES.values())


def unrepeatable_devices(names: Iterable[str]) -> tuple[str, ...]:
    """Return what does not repeat: devices such as ``phoenix6 Talon FX 11``, mechanisms such as ``wpilib ElevatorSim``.

    :param names: the SimDevices of the robot
    """
    found = set()
    for module in unrepeatable_libraries():
        for name in names:
            if match := _DEVICES[module].match(name):
                found.add((module, match[1], int(match[2])))
    devices = [f"{module} {kind} {number}" for module, kind, number in sorted(found)]
    return (*devices, *(f"wpilib {kind}" for kind in sorted(_noisy_mechanisms)))


def explain_unrepeatable(devices: Sequence[str]) -> str:
    """Return a sentence for each library of `unrepeatable_devices`: the devices, the reason and what to do."""
    return " ".join(_sentences(devices))


def _sentences(devices: Sequence[str]) -> Iterator[str]:
    for library, group in groupby(devices, lambda device: device.split(" ", 1)[0]):
        names = [device.split(" ", 1)[1] for device in group]
        rest = [counted(len(names) - _NAMED, "more device")] if len(names) > _NAMED else []
        *first, last = names[:_NAMED] + rest
        listed = f"{', '.join(first)} and {last}" if first else last
        verb, them, their = ("does", "it", "its") if len(names) == 1 else ("do", "them", "their")
        reason, remedy = (text.format(them=them, their=their) for text in _REASONS[library])
        yield f"{listed} {verb} not repeat exactly, because {reason}: {remedy}."
