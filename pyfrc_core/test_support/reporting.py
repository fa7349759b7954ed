"""Failures as a student reads them: the user's own file and line first, then what happened."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..errors import RobotCodeError, UsageError
from ..robot_files import RobotFiles, is_pyfrc
from ..runtime.endings import TestFroze

if TYPE_CHECKING:
    import pytest


class NamesItsPlace(Exception):
    """An error whose message begins with the user's file and line."""


def leave_out_pyfrc(error: BaseException, files: RobotFiles) -> None:
    """Take pyfrc's own part out of the traceback of what the user's code raised, or made pyfrc raise."""
    entry = error.__traceback__
    if files.innermost_line(entry) is None:
        return
    while entry is not None:
        while entry.tb_next is not None and is_pyfrc(entry.tb_next.tb_frame.f_code.co_filename):
            entry.tb_next = entry.tb_next.tb_next
        entry = entry.tb_next


def headline(error: BaseException, files: RobotFiles) -> str | None:
    """``robot.py:12: ZeroDivisionError: division by zero``, if the user's code took part in it."""
    if isinstance(error, (RobotCodeError, UsageError, NamesItsPlace)) or (isinstance(error, TestFroze) and str(error)):
        return str(error)  # these name the place themselves
    line = files.innermost_line(error.__traceback__)
    return f"{line}: {type(error).__name__}: {error}".rstrip(": ") if line else None


def put_first(report: pytest.TestReport, text: str) -> None:
    """Show `text` before everything else that pytest shows of a failure, and in its summary."""
    from _pytest._code.code import ExceptionChainRepr, ReprEntryNative

    longrepr = report.longrepr
    if isinstance(longrepr, ExceptionChainRepr):
        entry: Any = ReprEntryNative([*(f"{line}\n" for line in text.splitlines()), "\n"])
        traceback = longrepr.chain[0][0]  # what is shown first
        traceback.reprentries = [entry, *traceback.reprentries]
        for _, crash, _ in longrepr.chain[-1:]:
            if crash is not None:
                crash.message = text.splitlines()[0]
        if longrepr.reprcrash is not None:
            longrepr.reprcrash.message = text.splitlines()[0]
    else:
        report.longrepr = f"{text}\n\n{longrepr}" if longrepr else text
