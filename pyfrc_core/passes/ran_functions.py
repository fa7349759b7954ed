"""Observe which of a project's functions run in a process, at little cost."""

from __future__ import annotations

import sys
import threading
from types import CodeType, FrameType
from typing import Any

from ..errors import UsageError
from ..project.robot_files import RobotFiles

#: A source file, and the line in which a function begins.
Place = tuple[str, int]

#: One of the tool numbers that `sys.monitoring` leaves unassigned; fuzz campaigns use another.
_TOOL = 3


class RanFunctions:
    """The functions that have run since `start`, in this process and, when it is forked, in the process before it."""

    def __init__(self, files: RobotFiles) -> None:
        self._files = files
        self.places: set[Place] = set()

    def start(self) -> None:
        """Begin. Before Python 3.12, no other tool (a debugger, coverage) may trace at the same time.

        :raises UsageError: when one does
        """
        if sys.version_info >= (3, 12):
            self._monitor()
            return
        if sys.gettrace() is not None:
            raise UsageError(
                "which functions run cannot be observed: another tool, such as coverage or a debugger, traces them",
                remedy="Leave out that tool, or --changed; or use Python 3.12 or newer, which can do both.",
            )
        known: set[CodeType] = set()

        def on_call(frame: FrameType, event: str, argument: object) -> None:
            if frame.f_code not in known:
                known.add(frame.f_code)
                self._record(frame.f_code)

        threading.settrace(on_call)
        sys.settrace(on_call)

    def _monitor(self) -> None:
        monitoring: Any = sys.monitoring  # type: ignore[attr-defined,unused-ignore]

        def on_start(code: CodeType, offset: int) -> Any:
            self._record(code)
            return monitoring.DISABLE

        monitoring.use_tool_id(_TOOL, "pyfrc test --changed")
        monitoring.register_callback(_TOOL, monitoring.events.PY_START, on_start)
        monitoring.set_events(_TOOL, monitoring.events.PY_START)

    def _record(self, code: CodeType) -> None:
        # A module's code may begin in the same line as its first function.
        if code.co_name != "<module>" and self._files.is_project_file(code.co_filename):
            self.places.add((code.co_filename, code.co_firstlineno))
