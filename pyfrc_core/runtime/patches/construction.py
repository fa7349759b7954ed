"""What the construction of a robot needs: no alarm that stops time, and an explanation when WPILib refuses it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ...compat.cpython_private import get_frame, outwards
from ...errors import RobotCodeError
from ...patch_table import Patch, patched
from ...project.robot_files import RobotFiles
from ...wpi import robots


@contextmanager
def without_first_alarm() -> Iterator[None]:
    """Cancel the alarm that `TimedRobot`'s constructor sets, as soon as it has set it.

    The HAL lets no time pass before a thread waits for that alarm, and none does: a robot whose own constructor
    waits after ``super().__init__()`` would hang.
    """

    def cancelling(robot_class: type[Any]) -> Patch:
        original = robot_class.__init__

        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
            __tracebackhide__ = True
            original(self, *args, **kwargs)
            robots.cancel_first_alarm(self)

        return Patch(robot_class, "__init__", __init__)

    with patched([cancelling(base) for base in robots.TIMED]):
        yield


@contextmanager
def refused(files: RobotFiles) -> Iterator[None]:
    """Refuse robots that are made, or run, while the program is imported.

    WPILib makes the robot, and its time would stand.
    """

    def refusing(robot_class: type[Any]) -> Patch:
        original = robot_class.__init__

        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
            __tracebackhide__ = True
            lines = list(filter(None, map(files.line_of_frame, outwards(get_frame(1)))))
            if not lines:
                original(self, *args, **kwargs)
                return
            raise RobotCodeError(
                f"a robot is made while the program is imported: {type(self).__name__}()",
                where=lines[-1],  # the outermost: the class has only been called there
                remedy="Delete this call: the robot program is its class, and pyfrc and WPILib make the robot.",
            )

        return Patch(robot_class, "__init__", __init__)

    def run(robot_class: type[Any], **kwargs: Any) -> None:
        __tracebackhide__ = True
        raise RobotCodeError(
            "wpilib.run() is called while the program is imported",
            where=files.line_of_frame(get_frame(1)),
            remedy="Remove this line: pyfrc and WPILib find the robot class and run it.",
        )

    runs = [Patch(owner, name, run) for owner, name in robots.RUN_THE_PROGRAM]
    with patched([*(refusing(base) for base in robots.BASES), *runs]):
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
