"""HAL time, which the runtime stops and steps.

The functions are bound when this module is imported, before the runtime patches the names that tests and robot code
call (such as `wpilib.simulation.stepTiming`), so they always reach the HAL itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from hal.simulation import (
    getNumNotifiers,
    isTimingPaused,
    pauseTiming,
    restartTiming,
    resumeTiming,
    stepTiming,
)
from wpilib import Timer

#: Advance HAL time by this many microseconds; wake the notifiers of C++ code that become due.
step_us = stepTiming

#: How many notifiers of C++ code there are.
count_notifiers = getNumNotifiers

#: Return HAL time, in seconds.
seconds = Timer.getFPGATimestamp


def stop_and_zero() -> None:
    """Stop HAL time at 0; from now on it advances only by `step_us`."""
    pauseTiming()
    restartTiming()


@contextmanager
def standing_at_zero() -> Iterator[None]:
    """Stop HAL time at 0 in this context, as when a robot's run begins; then let it follow the wall clock again.

    What robot code makes while it is imported, such as a `SlewRateLimiter`, takes its first time from it. Where HAL
    time is stopped already, for a run that is about to begin, nothing is changed.
    """
    if isTimingPaused():
        yield
        return
    stop_and_zero()
    try:
        yield
    finally:
        run_freely()


def run_freely() -> None:
    """Let HAL time follow the wall clock again."""
    resumeTiming()
