"""`get` of motor controllers that do not ask the HAL, but return what their object was last given.

REV's ``SparkMax.get()`` is one, and a team's own motor controller class may be another.
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
        """Have `get` return 0.

        :returns: what restores it, for each class
        """
        if len(sys.modules) != self._modules:  # classes come with modules
            self._modules = len(sys.modules)
            self._classes = _classes()
        for owner in self._classes:
            original = vars(owner)["get"]
            owner.get = _zero
            yield partial(setattr, owner, "get", original)


def _zero(*_: object, **__: object) -> float:
    return 0.0


def _classes() -> list[type[Any]]:
    """Classes with a `get` of their own, if there are any besides WPILib's: those for PWM ask the HAL."""
    found: list[type[Any]] = []
    derived: list[type[Any]] = MotorController.__subclasses__()
    while derived:
        each = derived.pop()
        if each.__module__.partition(".")[0] != "wpilib" and callable(vars(each).get("get")):
            found.append(each)
        derived += each.__subclasses__()
    return [*dict.fromkeys(found), wpilib.MotorControllerGroup] if found else []
