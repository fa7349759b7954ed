"""Waits for WPILib's events, such as the driver station's for a new packet, in robot time.

WPILib sets most of them in C++, which does not say when. A thread that waits looks again after each packet.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..clock import PACKET_US, to_us
from ..threads.robot_threads import RobotThreads
from .active_run import active_run


def in_robot_time(real: Callable[..., Any]) -> Callable[..., Any]:
    """Return what replaces the function of `wpiutil.sync` that waits for one event."""

    def wait_for_object(handle: int, *timeout: float, **named: float) -> Any:
        __tracebackhide__ = True
        run = active_run.run
        given = next(iter((*timeout, *named.values())), None)
        if run is None or given == 0 or not run.threads.takes_part():
            return real(handle, *timeout, **named)
        is_set, timed_out = _wait(run.threads, real, handle, given)
        return is_set if given is None else (is_set, timed_out)

    return wait_for_object


def _wait(threads: RobotThreads, real: Callable[..., Any], handle: int, timeout: float | None) -> tuple[bool, bool]:
    """Return whether the event was set, and whether the time, in seconds, was out first."""
    __tracebackhide__ = True
    clock = threads.clock
    give_up_us = None if timeout is None else clock.now_us + to_us(timeout)
    seen: list[bool] = []

    def is_over() -> bool:
        if not seen:
            is_set, not_yet = real(handle, 0.0)
            if is_set or not not_yet:  # neither: it is destroyed
                seen.append(is_set)
        return bool(seen)

    while not is_over():
        wait_us = PACKET_US - clock.now_us % PACKET_US
        if give_up_us is not None:
            if give_up_us <= clock.now_us:
                return False, True
            wait_us = min(wait_us, give_up_us - clock.now_us)
        threads.wait([], is_over, wait_us)
    return seen[0], False
