"""Override `get` of motor controllers that return the value last set, and not that of the HAL.

REV's ``SparkMax.get()`` is an example; a team's own motor controller class may be another.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import wpilib
from wpilib.interfaces import MotorController


class MotorGetters:
    """The `get` of vendors' and teams' motor controller classes."""

    def __init__(self) -> None:
        self._modules = 0
        self._classes: list[type[Any]] = []

    def turn_off(self) -> Iterator[Callable[[], None]]:
        """Make `get` return 0.

        :returns: a function for each class that restores it
        """
        if len(sys.modules) != self._modules:  # new modules may have new classes
            self._modules = len(sys.modules)
            self._classes = _classes()
        for owner in self._classes:
            original = vars(owner)["get"]
            owner.get = _zero
            yield partial(setattr, owner, "get", original)


def _zero(*_: object, **__: object) -> float:
    return 0.0


def _classes() -> list[type[Any]]:
    """Return the classes with their own `get`, if there are any besides WPILib's: those for PWM read the HAL."""
    found: list[type[Any]] = []
    derived: list[type[Any]] = MotorController.__subclasses__()
    while derived:
        each = derived.pop()
        if each.__module__.partition(".")[0] != "wpilib" and callable(vars(each).get("get")):
            found.append(each)
        derived += each.__subclasses__()
    return [*dict.fromkeys(found), wpilib.MotorControllerGroup] if found else []
