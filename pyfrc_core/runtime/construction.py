"""What the construction of a robot needs: no alarm that stops time, and an explanation when WPILib refuses it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import wpilib

from ..compat.wpilib_private import end_competition
from ..errors import RobotCodeError
from .patch_table import Patch, patched


@contextmanager
def without_first_alarm() -> Iterator[None]:
    """Cancel the alarm that `wpilib.TimedRobot`'s constructor sets, as soon as it has set it.

    The HAL lets no time pass before a thread waits for that alarm, and none does: a robot whose own constructor
    waits after ``super().__init__()`` would hang.
    """
    original = wpilib.TimedRobot.__init__

    def __init__(self: wpilib.TimedRobot, *args: Any, **kwargs: Any) -> None:
        __tracebackhide__ = True
        original(self, *args, **kwargs)
        end_competition(self)

    with patched([Patch(wpilib.TimedRobot, "__init__", __init__)]):
        yield


def missing_super_init(robot_class: type[object], error: TypeError) -> RobotCodeError | None:
    """WPILib complains of a forgotten ``super().__init__()`` without naming the place; this does."""
    code = getattr(robot_class.__init__, "__code__", None)
    if code is None or "__init__() must be called when overriding" not in str(error):
        return None
    return RobotCodeError(
        f"{robot_class.__name__}.__init__ does not call super().__init__()",
        where=f"{Path(code.co_filename).name}:{code.co_firstlineno}",
        remedy="Make that its first line.",
    )
