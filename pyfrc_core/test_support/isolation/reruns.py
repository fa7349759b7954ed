"""Plugins that run a failed test again, such as pytest-rerunfailures: they have no effect on tests with the robot.

Such a plugin runs a test by itself, in pytest's process. Most tests with the robot would fail again in the same way,
since their runs repeat exactly; so this is printed, and not imitated.
"""

from __future__ import annotations

from collections.abc import Iterable

import pytest

#: The options of pytest-rerunfailures, pytest-retry and flaky, and the mark that each of them reads.
_OPTIONS = ("reruns", "retries", "force_flaky")
_MARK = "flaky"


def reruns_notice(config: pytest.Config, robot_tests: Iterable[pytest.Item]) -> str:
    """Return a sentence if the user wants tests to run again, and some of them use the robot; else an empty text."""
    tests = list(robot_tests)
    asked = [name for name in _OPTIONS if getattr(config.option, name, None)]
    plugins = any(hasattr(config.option, name) for name in _OPTIONS)
    if asked:
        what = f"--{asked[0].replace('_', '-')}"
    elif plugins and any(test.get_closest_marker(_MARK) for test in tests):
        what = f"the mark {_MARK}"
    else:
        return ""
    return f"{what} has no effect on tests that use the robot. With --no-isolation, it has." if tests else ""
