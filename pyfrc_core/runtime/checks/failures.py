"""Failures as a student reads them: the user's own file and line first, then what happened."""

from __future__ import annotations

import re
import threading

from ...errors import PyfrcError, RobotCodeError, UsageError, text_of
from ...explain import Explanation, explain
from ...explain.places import place_without_line
from ...project.robot_files import RobotFiles, is_library, is_pyfrc
from ..exceptions import TestFroze

_STACK_ENTRY = re.compile(r'  File "([^"]+)", line \d+, in [^\n]*\n(?:    [^\n]*\n)?\n?')

#: How many calls of libraries are shown.
_SHOWN_CALLS = 4


class NamesItsPlace(Exception):
    """An error whose message begins with the user's file and line."""


def leave_out_libraries(error: BaseException, files: RobotFiles) -> None:
    """Remove the calls in libraries, and in pyfrc, from the traceback of an error that has a line of the user's.

    Also from the errors that led to it.
    """
    seen: list[BaseException] = []
    each: BaseException | None = error
    while each is not None and each not in seen:
        seen.append(each)
        _leave_out(each, files)
        each = each.__cause__ or (None if each.__suppress_context__ else each.__context__)


def _leave_out(error: BaseException, files: RobotFiles) -> None:
    entry = error.__traceback__
    if files.innermost_line(entry) is None:
        return
    if error.args and isinstance(error.args[0], str) and "\n  File " in error.args[0]:
        # WPILib reports where a device was made before, with the whole stack.
        error.args = (_STACK_ENTRY.sub(lambda found: _ours(found, files), error.args[0]).strip(), *error.args[1:])
    while entry is not None:
        while entry.tb_next is not None and is_library(entry.tb_next.tb_frame.f_code.co_filename):
            entry.tb_next = entry.tb_next.tb_next
        entry = entry.tb_next


def headline(error: BaseException, files: RobotFiles) -> str | None:
    """Return ``robot.py:12: ZeroDivisionError: division by zero``, and in further lines what to do.

    None if the user's code took no part in it.
    """
    if names_its_place(error) or (isinstance(error, TestFroze) and str(error)):
        return str(error)
    traceback = error.__traceback__
    explained = explain(error, files) or Explanation()
    line = explained.place or files.innermost_line(traceback, tests=False)
    text = explained.text or text_of(error)
    if not line and (line := place_without_line(error, files)):
        text = with_library_calls(text, error, files)
    line = line or files.innermost_line(traceback)
    return f"{line}: {text}" + (f"\n  {explained.remedy}" if explained.remedy else "") if line else None


def headline_is_the_robots(text: str, files: RobotFiles) -> bool:
    """Whether a headline names a line of the robot's code, and not one of a test."""
    name = text.partition(":")[0]
    return files.is_robot_code(files.root + name)


def as_robot_code_error(error: BaseException, files: RobotFiles) -> PyfrcError:
    """What the user's code raised, as an error that names its line."""
    if isinstance(error, PyfrcError):
        return error
    text = headline(error, files)
    return RobotCodeError(text if text is not None else with_library_calls(text_of(error), error, files))


def with_library_calls(text: str, error: BaseException, files: RobotFiles) -> str:
    """Add the calls in libraries to the first line of a text about an exception, if no line of the robot's is known."""
    first, newline, rest = text.partition("\n")
    calls = library_calls(error, files)
    return f"{first} (in {calls}){newline}{rest}" if calls else text


def library_calls(error: BaseException, files: RobotFiles) -> str:
    """Return the calls in libraries that led to an exception without a line of the robot's, innermost first.

    Such as ``DriveDistance.execute, called by CommandScheduler.run``: methods are named after the object's class, which
    may be one of the robot's. Empty if the robot's code took part, or only pyfrc did.
    """
    if files.innermost_line(error.__traceback__) is not None:
        return ""
    names: list[str] = []
    entry = error.__traceback__
    while entry is not None:
        frame, entry = entry.tb_frame, entry.tb_next
        if is_pyfrc(frame.f_code.co_filename):
            names = []  # what came before has called pyfrc, and is the test's
            continue
        if frame.f_code.co_filename == threading.__file__:
            continue
        owner = frame.f_locals.get("self")
        of = frame.f_globals.get("__name__", "") if owner is None else type(owner).__name__
        name = f"{of}.{frame.f_code.co_name}"
        if names[-1:] != [name]:
            names.append(name)
    return ", called by ".join(reversed(names[-_SHOWN_CALLS:]))


def names_its_place(error: BaseException) -> bool:
    """Whether the message says it all: what is wrong, where, and what to do."""
    if isinstance(error, (RobotCodeError, UsageError)):
        return error.where is not None
    return isinstance(error, NamesItsPlace)


def _ours(entry: re.Match[str], files: RobotFiles) -> str:
    return entry[0] if files.is_project_file(entry[1]) else ""
