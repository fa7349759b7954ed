"""What lets time pass, and brings packets, where tests and robot code call it themselves: it moves the run.

Each season's table has these functions under WPILib's names; while no robot runs, they do what the original does.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from ...patch_table import Patch
from ..clock import to_us
from ..exceptions import TestEnded
from ..threads import cooperative
from .active_run import active_run

_real_sleep = time.sleep


def wait(seconds: float) -> None:
    """Do what `wpilib.wait` does, in robot time."""
    __tracebackhide__ = True
    threads = cooperative.scope.taking_part()
    if threads is None:
        return _real_sleep(seconds)
    return threads.sleep_until(threads.clock.now_us + max(0, to_us(seconds)))


def stepping(owner: object, name: str, in_us: Callable[[Any], int]) -> Patch:
    """Return the patch of a function that steps WPILib's simulated time: the robot moves with it.

    :param in_us: returns the microseconds of the function's argument
    """
    real = getattr(owner, name)

    def step(delta: float) -> None:
        __tracebackhide__ = True
        run = active_run.run
        if run is None:
            real(delta)
            return
        target_us = run.clock.now_us + in_us(delta)
        if run.sleep_on_robot_thread(target_us):
            return
        try:
            run.clock.run_until(target_us)
        except TestEnded:
            if run.threads.failure is None:
                raise
            raise run.threads.failure from None  # to the test, which has called this

    return Patch(owner, name, step)


def left_to_the_run(owner: object, name: str) -> Patch:
    """Return the patch of a function that does nothing while a robot runs."""
    real = getattr(owner, name)

    def call() -> None:
        if active_run.run is None:
            real()

    return Patch(owner, name, call)


def delivering(owner: object, name: str, refresh: Callable[[], object] | None) -> Patch:
    """Return the patch of a function by which a test delivers a packet out of turn: a recorder must record it.

    :param refresh: has the robot take in the packet, if the function does so
    """
    real = getattr(owner, name)

    def notify() -> None:
        run = active_run.run
        if run is None:
            real()
            return
        if run.recorder is not None:
            run.recorder.on_packet_out_of_turn()
        run.connection.packet()
        if refresh is not None:
            refresh()

    return Patch(owner, name, notify)
