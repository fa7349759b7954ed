"""`wpilib.TimesliceRobot`: its functions are in WPILib's own schedule in C++, which only WPILib's own loop serves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

from ...patch_table import Patch
from .active_run import active_run
from .made_devices import noting

#: Of each robot: when its next function begins in each period, and the period, in seconds.
_next_slices: WeakKeyDictionary[Any, tuple[float, float]] = WeakKeyDictionary()


def note(robot: Any, allocation: float, period: float) -> None:
    """Note the arguments of a robot's constructor, in seconds: the time for its own turn, and the period."""
    _next_slices[robot] = (allocation, period)


def patches(robot_class: type[Any], note_arguments: Callable[..., None]) -> list[Patch]:
    """Return the names to replace.

    :param robot_class: `wpilib.TimesliceRobot`
    :param note_arguments: `note`, with the names that the season has for the arguments
    """
    real: Callable[..., None] = robot_class.schedule

    def schedule(robot: Any, func: Callable[[], object], allocation: float) -> None:
        __tracebackhide__ = True
        run = active_run.run
        if run is None:
            return real(robot, func, allocation)
        real(robot, _do_nothing, allocation)  # refuses what does not fit into the period
        begin, period = _next_slices[robot]
        _next_slices[robot] = (begin + allocation, period)
        return run.timed_loop.add(robot, func, period, begin)

    return [noting(robot_class, note_arguments), Patch(robot_class, "schedule", schedule)]


def _do_nothing() -> None:
    pass
