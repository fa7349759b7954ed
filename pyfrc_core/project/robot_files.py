"""The source files of a robot project: their `time.sleep` is robot time, and errors show their lines first."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from types import FrameType, TracebackType

from ..compat.cpython_private import current_frames, outwards

# A virtual environment inside the project contains libraries.
_NOT_OURS = (f"{os.sep}site-packages{os.sep}", f"{os.sep}dist-packages{os.sep}")
_PYFRC = tuple(
    str(Path(__file__).resolve().parents[2] / package) + os.sep for package in ("pyfrc_core", "pyfrc", "pyfrc_cli")
)
_PYTHON = str(Path(os.__file__).parent) + os.sep


def is_pyfrc(filename: str) -> bool:
    """Return whether this file is part of pyfrc."""
    return filename.startswith(_PYFRC)


def is_library(filename: str) -> bool:
    """Return whether this file is part of pyfrc, of an installed package, or of Python."""
    return filename.startswith((*_PYFRC, _PYTHON, "<frozen")) or any(part in filename for part in _NOT_OURS)


def tests_beside(root: Path) -> Path:
    """Return the directory of tests beside a project; for a project that is called so itself, the one in it."""
    return (root if root.name.lower() == "tests" else root.parent) / "tests"


class RobotFiles:
    """The source files of one robot project.

    :param root: the directory that holds robot.py
    """

    def __init__(self, root: Path) -> None:
        self.root = str(root) + os.sep
        self._tests = str(root / "tests") + os.sep
        self._tests_beside = str(tests_beside(root)) + os.sep
        self._known: dict[str, bool] = {}

    def is_robot_code(self, filename: str) -> bool:
        """Return whether this file is part of the robot program; its tests are not."""
        known = self._known.get(filename)
        if known is None:
            known = self.is_project_file(filename) and not filename.startswith((self._tests, self._tests_beside))
            self._known[filename] = known
        return known

    def is_project_file(self, filename: str) -> bool:
        """Return whether this file belongs to the project: the robot program or its tests."""
        if any(part in filename for part in _NOT_OURS) or filename.startswith(_PYFRC):
            return False
        return filename.startswith((self.root, self._tests_beside))

    def relative(self, filename: str) -> str:
        """Return the file name to show to the user: relative to the project."""
        if filename.startswith(self._tests_beside):
            return str(Path("..", "tests", filename.removeprefix(self._tests_beside)))
        return filename.removeprefix(self.root)

    def innermost_line(self, traceback: TracebackType | None, tests: bool = True) -> str | None:
        """Return the user's line nearest to where an exception was raised, such as ``robot.py:12``, if there is one.

        A line of the robot program has precedence over a test's, which only called it. Without `tests`, lines of tests
        are ignored.
        """
        entry = innermost_entry(traceback, self.is_robot_code)
        if entry is None and tests:
            entry = innermost_entry(traceback, self.is_project_file)
        return f"{self.relative(entry.tb_frame.f_code.co_filename)}:{entry.tb_lineno}" if entry is not None else None

    def line_of_thread(self, ident: int) -> str | None:
        """Return the user's line that a running thread is at, such as ``robot.py:12``, if it is in the user's code."""
        return self.line_of_call(current_frames().get(ident))

    def line_of_call(self, frame: FrameType | None) -> str | None:
        """Return the user's line, such as ``robot.py:12``, that has called what runs in a frame; None if none has."""
        return next(filter(None, map(self.line_of_frame, outwards(frame))), None)

    def line_of_frame(self, frame: FrameType) -> str | None:
        """Return the line that a frame is at, such as ``robot.py:12``, if it is in the user's code."""
        filename = frame.f_code.co_filename
        return f"{self.relative(filename)}:{frame.f_lineno}" if self.is_project_file(filename) else None


def past_pyfrc(traceback: TracebackType | None) -> TracebackType | None:
    """Return a traceback without pyfrc's own entries at its beginning; its last entry stays."""
    while traceback is not None and traceback.tb_next is not None and is_pyfrc(traceback.tb_frame.f_code.co_filename):
        traceback = traceback.tb_next
    return traceback


def innermost_entry(traceback: TracebackType | None, is_ours: Callable[[str], bool]) -> TracebackType | None:
    """Return the entry of a traceback nearest to where the exception was raised, of those in some files.

    :param is_ours: returns whether a file, by its name, is one of them
    """
    found = None
    while traceback is not None:
        if is_ours(traceback.tb_frame.f_code.co_filename):
            found = traceback
        traceback = traceback.tb_next
    return found
