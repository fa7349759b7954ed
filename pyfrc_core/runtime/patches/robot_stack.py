"""The stack that WPILib prints with an error or a warning: of the robot's own lines, not of what drives the robot.

On a robot the user's code is nearly all that there is on it. Here a dozen calls of the runtime come before.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

from ...compat.cpython_private import get_frame
from ...patch_table import Patch
from ...project.robot_files import RobotFiles
from ...wpi import reports


def show_robots_lines(files: Callable[[], RobotFiles]) -> None:
    """From now on, what is reported from C++ comes with the lines of the project that led there."""
    reports.show_stack(lambda: _lines(files(), get_frame(1)))


def show_all_lines() -> None:
    """From now on, it comes with all lines, as without this module."""
    reports.show_whole_stack()


def patches(files: Callable[[], RobotFiles]) -> list[Patch]:
    """Return the replacements of WPILib's functions that report with a stack of their own."""

    def reporting(owner: Any, name: str) -> Patch:
        real = getattr(owner, name)

        def report(error: str, print_trace: bool = False, **named: bool) -> None:
            (print_trace,) = named.values() or (print_trace,)  # each season has its own name for it
            # Of an exception that is being handled they print the traceback, which has nothing of ours.
            if print_trace and sys.exc_info()[1] is None:
                error = f"{error}\n{_lines(files(), get_frame(1))}"
                print_trace = False
            real(error, print_trace)

        report.__name__ = name
        return Patch(owner, name, report)

    return [reporting(owner, name) for owner, name in reports.WITH_STACK]


def _lines(files: RobotFiles, frame: FrameType | None) -> str:
    import traceback

    calls = [call for call in traceback.walk_stack(frame) if files.is_project_file(call[0].f_code.co_filename)]
    return "".join(traceback.StackSummary.extract(reversed(calls)).format())
