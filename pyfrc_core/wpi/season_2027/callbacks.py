"""Functions of robot code that WPILib, commands2 and magicbot call: methods of their derived classes, and arguments."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import telemetry
import wpilib

from . import names

#: All classes of robot code that libraries call derive from one of these.
BASES: tuple[type[Any], ...] = (wpilib.RobotBase, wpilib.OpMode, telemetry.TelemetryLoggable)

#: The methods that are called, by the base class, with what such an object is.
_CALLED = {
    "IterativeRobotBase": ("robot", names.OF_MODES),
    "MagicRobot": ("robot", names.OF_MODES),
    "OpModeRobotBase": ("robot", names.OF_MODES),
    "OpMode": ("opmode", names.OF_AN_OPMODE),
    "Command": ("command", names.OF_A_COMMAND),
    "Subsystem": ("subsystem", names.OF_A_SUBSYSTEM),
}

#: Where commands and triggers take functions.
_GIVEN_TO_COMMANDS = (
    *(f"{name}.__init__" for name in ("FunctionalCommand", "ConditionalCommand", "WaitUntilCommand")),
    *(f"{name}.__init__" for name in ("SelectCommand", "DeferredCommand", "Trigger")),
    *(f"Command.{name}" for name in ("only_while", "finally_do", "handle_interrupt")),
)


def called_methods(cls: type) -> tuple[str, frozenset[str]]:
    """Return what the objects of a class are, and the names of its methods that libraries call in each loop.

    Of a robot with a loop of its own, any method may be a part of it. Empty for other classes.
    """
    bases = {base.__name__ for base in cls.__mro__ if base.__module__.partition(".")[0] in names.LIBRARIES}
    found = next((_CALLED[base] for base in _CALLED if base in bases), None)
    if found is None and "RobotBase" in bases:
        found = "robot", frozenset(name for name in vars(cls) if name[:2] != "__") - names.OF_A_LOOP
    return found or ("", frozenset())


def has_components(cls: type) -> bool:
    """Return whether the class's annotations name components, whose methods are called (`names.OF_A_COMPONENT`)."""
    return any(base.__name__ == "MagicRobot" and base.__module__.startswith("magicbot") for base in cls.__mro__)


def is_component(kind: object) -> bool:
    """Return whether an annotation names a component, and no device or plain value."""
    return isinstance(kind, type) and not issubclass(kind, (telemetry.TelemetryLoggable, int, float, str))


def functions_taken() -> Iterator[tuple[type[Any], str]]:
    """Yield the methods that take functions to call, as classes and names; those of commands, too, once imported."""
    yield wpilib.EventLoop, "bind"
    if "commands2" in sys.modules:
        import commands2.button

        for place in _GIVEN_TO_COMMANDS:
            where, _, method = place.partition(".")
            yield getattr(commands2, where, None) or getattr(commands2.button, where), method
