"""What WPILib reports on the console, and with which lines of the stack."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import hal
import wpilib
import wpiutil._wpiutil

from ...compat.private_name import PrivateName

STACK_TRACE_HOOK = PrivateName(
    "wpiutil._stacktrace:_stack_trace_hook", "runtime.patches.robot_stack puts it back when the patches are undone"
)
SET_STACK_TRACE_HOOK = PrivateName(
    "wpiutil._wpiutil:_setup_stack_trace_hook",
    "runtime.patches.robot_stack has WPILib's errors come with the robot's lines by it",
)


#: An error as WPILib writes it to standard error; the group is its text.
ERROR = re.compile(rb"^Error at ([^\n]*)\n", re.MULTILINE)
#: Errors that are no fault of the robot's code: joysticks that are not plugged in; slow loops, which pyfrc detects in a
#: better way; drives without a command for a tenth of a second, which every robot has while it stands still.
NO_FAULT = re.compile(rb"Joystick .*not (?:available|attached|plugged)|Loop time of|Output not updated", re.IGNORECASE)


_ERROR_CODE = 1

#: WPILib's functions that report with a stack of their own, if asked to.
WITH_STACK: tuple[tuple[Any, str], ...] = ((wpilib, "report_error"), (wpilib, "report_warning"))


def report_error(message: str, where: str) -> None:
    """Report an error to the driver station, and print it. The HAL drops a message with the same text as the last."""
    hal.send_error(True, _ERROR_CODE, message, where, "", True)


def show_stack(lines: Callable[[], str]) -> None:
    """Have what WPILib's C++ code reports from now on come with these lines, if this version has such a hook.

    :param lines: called for each report, on the stack that led to it
    """
    _set_stack_trace_hook(lambda offset: lines())


def show_whole_stack() -> None:
    """Undo `show_stack`."""
    _set_stack_trace_hook(STACK_TRACE_HOOK.find())


def _set_stack_trace_hook(hook: Callable[[int], str]) -> None:
    if hasattr(wpiutil._wpiutil, SET_STACK_TRACE_HOOK.name):  # without it reports come with all lines, no more
        SET_STACK_TRACE_HOOK.of(wpiutil._wpiutil)(hook)
