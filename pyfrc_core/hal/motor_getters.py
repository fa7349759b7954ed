"""Override `get` of motor controllers that return the value last set, and not that of the HAL.

REV's ``SparkMax.get()`` is an example; a team's own motor controller class may be another.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from ..wpi import motor_controllers


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
            self._classes = motor_controllers.with_own_getter()
        name = motor_controllers.POWER_GETTER
        for owner in self._classes:
            original = vars(owner)[name]
            setattr(owner, name, _zero)
            yield partial(setattr, owner, name, original)


def _zero(*_: object, **__: object) -> float:
    return 0.0
