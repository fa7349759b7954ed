"""Refuse ``input()`` in robot code, with its line: a robot has no keyboard and would wait forever."""

from __future__ import annotations

import builtins

from ..compat.cpython_private import get_frame
from ..errors import RobotCodeError
from ..patch_table import PatchTable
from ..project.robot_files import RobotFiles
from ..wpi import names

_real_input = builtins.input
_files: list[RobotFiles] = []


def refuse_keyboard_input(files: RobotFiles) -> None:
    """Have ``input()`` raise an error when it is called from one of these files; others read as before.

    Calling it again only changes the files.
    """
    _files[:] = [files]
    PatchTable().patch(builtins, "input", _input)


def _input(prompt: object = "", /) -> str:
    __tracebackhide__ = True
    caller = get_frame(1)
    filename = caller.f_code.co_filename
    if not any(files.is_robot_code(filename) for files in _files):
        return _real_input(prompt)
    raise RobotCodeError(
        "input() waits for a keyboard, and a robot has none",
        where=f"{_files[0].relative(filename)}:{caller.f_lineno}",
        remedy=f"Ask the driver station instead: a {names.CHOICES} to choose, a joystick or gamepad to drive.",
    )
