"""Show the user's own file and line before everything else that pytest shows of a failure."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pytest


#: The attribute of a report that identifies the bug of the robot's code.
BUG = "pyfrc_bug"

#: Numbers in a message, such as times, differ from test to test.
_NUMBER = re.compile(r"\d+(\.\d+)?(e-?\d+)?")


def put_first(report: pytest.TestReport, text: str, only: bool = False) -> None:
    """Show `text` before everything else that pytest shows of a failure, and in its summary.

    :param only: leave out everything else
    """
    from _pytest._code.code import ExceptionChainRepr, ReprEntryNative

    longrepr = report.longrepr
    if isinstance(longrepr, ExceptionChainRepr):
        entry: Any = ReprEntryNative([*(f"{line}\n" for line in text.splitlines()), "\n"])
        if only:
            longrepr.chain = longrepr.chain[-1:]
        traceback = longrepr.chain[0][0]  # the first part that pytest shows
        traceback.reprentries = [entry] if only else [entry, *traceback.reprentries]
        traceback.extraline = None if only else traceback.extraline
        for _, crash, _ in longrepr.chain[-1:]:
            if crash is not None:
                crash.message = text.splitlines()[0]
        if longrepr.reprcrash is not None:
            longrepr.reprcrash.message = text.splitlines()[0]
    else:
        report.longrepr = f"{text}\n\n{longrepr}" if longrepr else text


def bug_of(headline: str | None) -> str | None:
    """Return the part of a headline that all failures by one bug have in common: the line, and the message without
    numbers.

    :param headline: such as ``robot.py:12: ZeroDivisionError: division by zero``
    """
    if headline is None or (found := re.match(r"[^\n]*?\.py:\d+: ", headline)) is None:
        return None
    return found[0] + _NUMBER.sub("#", headline[found.end() :].partition("\n")[0])
