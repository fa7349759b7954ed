"""HAL time, which the runtime stops and steps.

WPILib 2027 counts nanoseconds, from when the computer was started, and never sets them back. So that runs repeat, HAL
time is moved on to a round number before a run: robot time 0 is there.

The functions are bound when this module is imported, before the runtime patches the names that tests and robot code
call (such as `wpilib.simulation.step_timing`), so they always reach the HAL itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from hal import get_monotonic_time
from hal.simulation import (
    get_num_notifiers,
    is_timing_paused,
    pause_timing,
    restart_timing,
    resume_timing,
    step_timing,
    step_timing_async,
)

NS_PER_US = 1_000
#: Runs begin at multiples of this, in nanoseconds: 11.6 days. As seconds, floats have 0.1 ns left there.
ROUND = 10**15

#: How many notifiers of C++ code there are.
count_notifiers = get_num_notifiers

#: HAL time at robot time 0, in nanoseconds.
_zero = 0


def step_us(us: int) -> None:
    """Advance HAL time by this many microseconds; wake the notifiers of C++ code that become due."""
    step_timing(us * NS_PER_US)


def seconds() -> float:
    """Return HAL time in seconds since robot time 0."""
    return (get_monotonic_time() - _zero) / 1e9


def hal_time(us: int) -> int:
    """Return the HAL's number for a robot time in microseconds."""
    return _zero + us * NS_PER_US


def robot_us(hal_time: int) -> int:
    """Return the robot time in microseconds of the HAL's number for a time."""
    return (hal_time - _zero) // NS_PER_US


def stop_and_zero() -> None:
    """Stop HAL time, which is robot time 0; from now on it advances only by `step_us`."""
    global _zero
    pause_timing()
    restart_timing()
    now = get_monotonic_time()
    if now % ROUND:  # else no time has passed since it was stopped there
        # Not `step_timing`, which waits for the threads of notifiers.
        step_timing_async(ROUND - now % ROUND)
    _zero = get_monotonic_time()


@contextmanager
def standing_at_zero() -> Iterator[None]:
    """Stop HAL time in this context, as when a robot's run begins.

    What robot code makes while it is imported, such as a `SlewRateLimiter`, takes its first time from it. HAL time
    stays stopped, for the run that follows: it could not be set back to where it began.
    """
    if not is_timing_paused():
        stop_and_zero()
    yield


def run_freely() -> None:
    """Let HAL time follow the wall clock again."""
    resume_timing()
