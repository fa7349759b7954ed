"""What went wrong in a match, told apart from other failures by its kind and the user's innermost line."""

from __future__ import annotations

import re
from dataclasses import dataclass
from types import CodeType, FrameType, TracebackType

from ..errors import text_of
from ..project.robot_files import RobotFiles
from ..runtime.exceptions import TestFroze
from ..runtime.failures import NamesItsPlace, headline
from ..runtime.loop_limit import LoopWaitsError

#: The kind of code that never ends.
HANGS = "hangs"
#: The kind of a periodic function that does not return.
WAITS = "loop_waits"
#: The kind of a process that ended.
PROCESS_ENDED = "process_ended"

_ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]+")


class MisbehaviorError(NamesItsPlace):
    """The robot has done, without an exception, what no robot should.

    :param kind: the setting that switches this off
    :param place: the user's line, such as ``robot.py:12``; empty when it cannot be told
    :param function: the function that this is in
    """

    def __init__(self, what: str, kind: str, place: str, function: str) -> None:
        super().__init__(f"{place}: {what}" if place else what)
        self.kind, self.place, self.function = kind, place, function


@dataclass(frozen=True)
class FuzzFailure:
    """What went wrong.

    :param kind: an exception's type, or what else it is
    :param place: the user's innermost line, such as ``robot.py:12``; of code that hangs its function's first, since the
        line that it is found in is chance; empty when it cannot be told
    :param function: the function that this is in
    :param text: what people are told: it begins with the line
    """

    kind: str
    place: str
    function: str
    text: str

    def same_as(self, other: FuzzFailure | None) -> bool:
        """Whether this is the same mistake."""
        return other is not None and (self.kind, self.place) == (other.kind, other.place)


def failure_of(error: BaseException, files: RobotFiles) -> FuzzFailure:
    """What an error says that a run has ended with."""
    if isinstance(error, MisbehaviorError):
        return FuzzFailure(error.kind, error.place, error.function, str(error))
    if isinstance(error, LoopWaitsError):  # which of its lines waits is chance
        return FuzzFailure(WAITS, error.begins_at, error.function, str(error))
    code, line = _innermost(error.__traceback__, files)
    text = _ADDRESS.sub("", headline(error, files) or text_of(error))
    if isinstance(error, TestFroze):
        place, function = _place(code, files), code.co_name if code else ""
        return FuzzFailure(HANGS, place, function, f"{place}: {function}() hangs" if place else "the robot code hangs")
    place = f"{files.relative(code.co_filename)}:{line}" if code else ""
    return FuzzFailure(type(error).__name__, place, code.co_name if code else "", text)


def user_frame(frame: FrameType | None, files: RobotFiles) -> FrameType | None:
    """The innermost frame of the robot's own code, from `frame` outwards."""
    while frame is not None and not files.is_robot_code(frame.f_code.co_filename):
        frame = frame.f_back
    return frame


def place_of(frame: FrameType | None, files: RobotFiles) -> tuple[str, str]:
    """The line that a frame is at, and its function."""
    if frame is None:
        return "", ""
    return f"{files.relative(frame.f_code.co_filename)}:{frame.f_lineno}", frame.f_code.co_name


def _innermost(traceback: TracebackType | None, files: RobotFiles) -> tuple[CodeType | None, int]:
    code, line = None, 0
    while traceback is not None:
        if files.is_robot_code(traceback.tb_frame.f_code.co_filename):
            code, line = traceback.tb_frame.f_code, traceback.tb_lineno
        traceback = traceback.tb_next
    return code, line


def _place(code: CodeType | None, files: RobotFiles) -> str:
    return f"{files.relative(code.co_filename)}:{code.co_firstlineno}" if code else ""
