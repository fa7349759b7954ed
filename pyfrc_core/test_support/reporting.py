"""Failures as a student reads them: the user's own file and line first, then what happened."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..errors import PyfrcError
from ..robot_files import RobotFiles
from ..runtime.endings import TestFroze

if TYPE_CHECKING:
    import pytest


def headline(error: BaseException, files: RobotFiles) -> str | None:
    """``robot.py:12: ZeroDivisionError: division by zero``, if the user's code took part in it."""
    if isinstance(error, PyfrcError) or (isinstance(error, TestFroze) and str(error)):
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
