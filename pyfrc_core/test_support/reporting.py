"""What pytest shows of a failure: the user's own file and line first, and pyfrc's own sections."""

from __future__ import annotations

import inspect
import os
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from ..compat import pytest_private
from ..errors import PyfrcError
from ..runtime.robot import RobotRun
from . import controller
from .options import READY_MADE_TESTS, TestOptions

if TYPE_CHECKING:
    import pytest


#: The attribute of a report that identifies the bug of the robot's code.
BUG = "pyfrc_bug"

#: The attribute of a report with the devices of the robot that do not repeat.
UNREPEATABLE = "pyfrc_unrepeatable"

#: The section of a report for a failure of a test that never ran the robot.
NEVER_RUN = (
    "pyfrc",
    "The robot was never run in this test: call control.run_test(...), or step inside `with control.run_robot():`.",
)

#: The same for one that never enabled the robot.
NEVER_ENABLED = (
    "pyfrc",
    "The robot was disabled in this test: write control.set_operator_control(enabled=True) before the run, or "
    "control.set_autonomous(enabled=True).",
)

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


def never_ran_the_robot(item: pytest.Item, failure: pytest.ExceptionInfo[BaseException]) -> bool:
    """Return whether a test with a robot failed before it ran the robot, for no other reason that is known."""
    run = (getattr(item, "funcargs", None) or {}).get("_robot_run")
    if not isinstance(run, RobotRun) or run.started:
        return False
    error = failure.value
    if isinstance(error, PyfrcError) or isinstance(getattr(error, "obj", None), controller.TestController):
        return False  # a wrong key of `hal_data`, a misspelled method of `control`
    function: Any = getattr(item, "function", None)
    if getattr(function, "__module__", "").startswith(READY_MADE_TESTS):
        return False  # that of docstrings looks at the robot's code only
    with suppress(OSError, TypeError):  # no function, or one without a file
        if re.search(r"^[^#\n]*\.run_(test|robot)\(", inspect.getsource(function), re.MULTILINE):
            return False  # it has failed before that line
    return all(str(entry.path) != controller.__file__ for entry in failure.traceback)


def never_enabled_the_robot(item: pytest.Item) -> bool:
    """Return whether a test of the user's ran its robot and never enabled it, by the words in it."""
    run = (getattr(item, "funcargs", None) or {}).get("_robot_run")
    with suppress(OSError, TypeError):
        source = inspect.getsource(getattr(item, "function", None))  # type: ignore[arg-type]
        if isinstance(run, RobotRun) and run.started:
            runs = re.search(r"^[^#\n]*control\.run_test\(lambda", source, re.MULTILINE)
            return runs is not None and re.search("enable|set_|practice|replay|mode", source) is None
    return False


def seed_section(options: TestOptions, item: pytest.Item) -> tuple[str, str]:
    """Return the section of a failure's report that shows why the run ended at once, if it did, and the random seed."""
    control = getattr(item, "funcargs", {}).get("control")
    early = getattr(control, "ended_early", "").removeprefix(f"{item.config.rootpath}{os.sep}")
    return "pyfrc", f"{early}random seed: {options.seed} (--seed {options.seed} repeats it)"
