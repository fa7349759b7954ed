"""Failures of a match; two are the same when their kind and the user's innermost line are equal."""

from __future__ import annotations

import re
from dataclasses import dataclass
from types import CodeType, FrameType
from typing import NamedTuple

from ...compat.cpython_private import outwards
from ...errors import text_of
from ...explain.places import frames_of
from ...invariants.watch import BrokenInvariantError
from ...project.robot_files import RobotFiles, innermost_entry
from ...runtime.checks.failures import NamesItsPlace, headline, library_calls, with_library_calls
from ...runtime.checks.loop_limit import LoopWaitsError
from ...runtime.exceptions import TestFroze

#: Kind of a failure: the code hangs.
HANGS = "hangs"
#: Kind of a failure: a periodic function does not return.
WAITS = "loop_waits"
#: Kind of a failure: the process ended.
PROCESS_ENDED = "process_ended"

#: Kind of a failure: a motor is set to move while the robot is disabled.
WHILE_DISABLED = "motors_while_disabled"
#: What a script's `found` calls the lines of code that do so at each start, and are no failure.
ALWAYS_SET = "always_set"

#: Failures that are reported once for a robot, wherever its code has more of them.
_ONCE = (WHILE_DISABLED,)

_ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]+")
_NUMBER = re.compile(r"\d+")


class MisbehaviorError(NamesItsPlace):
    """The robot misbehaves without raising an exception.

    :param kind: the setting that disables this check
    :param place: the user's line, such as ``robot.py:12``; empty when it is unknown
    :param function: the name of the function with that line
    """

    def __init__(self, what: str, kind: str, place: str, function: str) -> None:
        super().__init__(f"{place}: {what}" if place else what)
        self.kind, self.place, self.function = kind, place, function


@dataclass(frozen=True)
class FuzzFailure:
    """A failure of the robot's code.

    :param kind: an exception's type, or one of the kinds of this package
    :param place: the user's innermost line, such as ``robot.py:12``; for code that hangs the first line of its
        function, since the line at which it is interrupted varies; empty when it is unknown
    :param function: the name of the function with that line
    :param text: the message for users, which begins with the line
    :param calls: the calls in libraries that led to an exception without a line of the user's
    """

    kind: str
    place: str
    function: str
    text: str
    calls: str = ""

    def same_as(self, other: FuzzFailure | None) -> bool:
        """Return whether both failures have the same cause."""
        return other is not None and self.cause == other.cause

    @property
    def cause(self) -> str:
        """Return a text that is the same for failures with the same cause."""
        if self.kind in _ONCE:
            return self.kind
        # Errors of the HAL have no line of the robot's, but different texts.
        what = _NUMBER.sub("0", self.text) if self.kind == "hal_errors" else self.place or self.calls
        return f"{self.kind} {what}".rstrip()


class NotedFailure(NamedTuple):
    """A failure after which the match went on.

    :param end_us: the end of a script in which it is the last event
    """

    failure: FuzzFailure
    end_us: int


def failure_of(error: BaseException, files: RobotFiles) -> FuzzFailure:
    """Return the failure that this error stands for."""
    if isinstance(error, MisbehaviorError | BrokenInvariantError):
        return FuzzFailure(error.kind, error.place, error.function, _ADDRESS.sub("", str(error)))
    if isinstance(error, LoopWaitsError):  # the line that waits varies
        return FuzzFailure(WAITS, error.begins_at, error.function, str(error))
    entry = innermost_entry(error.__traceback__, files.is_robot_code)
    text = _ADDRESS.sub("", headline(error, files) or with_library_calls(text_of(error), error, files))
    if isinstance(error, TestFroze):
        code = _code_at(str(error).partition(": ")[0], error, files)
        place = f"{files.relative(code.co_filename)}:{code.co_firstlineno}" if code else ""
        function = code.co_name if code else ""
        return FuzzFailure(HANGS, place, function, f"{place}: {function}() hangs" if place else "the robot code hangs")
    calls = library_calls(error, files)
    kind = type(error).__name__
    if entry is None:
        return FuzzFailure(kind, "", calls.partition(",")[0], text, calls)
    code = entry.tb_frame.f_code
    place = f"{files.relative(code.co_filename)}:{entry.tb_lineno}"
    return FuzzFailure(kind, place, code.co_name, text, calls)


def user_frame(frame: FrameType | None, files: RobotFiles) -> FrameType | None:
    """Return the innermost frame of the robot's own code, from `frame` outwards."""
    return next((call for call in outwards(frame) if files.is_robot_code(call.f_code.co_filename)), None)


def place_of(frame: FrameType | None, files: RobotFiles) -> tuple[str, str]:
    """Return the line at which a frame is, and the name of its function."""
    if frame is None:
        return "", ""
    return f"{files.relative(frame.f_code.co_filename)}:{frame.f_lineno}", frame.f_code.co_name


def _code_at(place: str, error: BaseException, files: RobotFiles) -> CodeType | None:
    """Return the innermost function on an error's stack that has this line; it may be in another line by now."""
    codes = [frame.f_code for frame in frames_of(error) if files.is_project_file(frame.f_code.co_filename)]
    name, _, line = place.rpartition(":")
    with_line = (
        code
        for code in reversed(codes)
        if files.relative(code.co_filename) == name and line in {str(each[2]) for each in code.co_lines()}
    )
    return next(with_line, codes[-1] if codes else None)
