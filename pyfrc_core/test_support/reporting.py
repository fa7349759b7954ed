"""Show the user's own file and line before everything else that pytest shows of a failure."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ..compat import pytest_private

if TYPE_CHECKING:
    import pytest


#: The attribute of a report that identifies the bug of the robot's code.
BUG = "pyfrc_bug"

#: The attribute of a report with the devices of the robot that do not repeat.
UNREPEATABLE = "pyfrc_unrepeatable"

#: Numbers in a message, such as times and addresses, differ from test to test.
_NUMBER = re.compile(r"0x[0-9a-f]+|\d+(\.\d+)?(e-?\d+)?")


def put_first(report: pytest.TestReport, text: str, only: bool = False) -> None:
    """Show `text` before everything else that pytest shows of a failure, and in its summary.

    :param only: leave out everything else
    """
    if not pytest_private.put_into_traceback(report, text, only):
        report.longrepr = f"{text}\n\n{report.longrepr}" if report.longrepr else text


def bug_of(headline: str | None) -> str | None:
    """Return the part of a headline that all failures by one bug have in common: the line, and the message without
    numbers.

    :param headline: such as ``robot.py:12: ZeroDivisionError: division by zero``
    """
    if headline is None or (found := re.match(r"[^\n]*?\.py:\d+: ", headline)) is None:
        return None
    return found[0] + _NUMBER.sub("#", headline[found.end() :].partition("\n")[0])
