"""Event loops (asyncio) that robot code runs, in robot time.

A loop asks `time.monotonic`, which gives it robot time, and waits in a selector: the replacement here polls what the
loop waits for, and lets robot time go on meanwhile. Loops that a test or a library runs keep real time.
"""

from __future__ import annotations

import selectors
import sys
from collections.abc import Callable
from typing import Any

from ...compat.cpython_private import get_frame
from ...patch_table import Patch
from ..robot_time import to_us
from . import cooperative

#: How often, in robot time, a loop that waits looks at its sockets, and at what other threads have sent it.
_POLL_US = 5_000


def patches() -> list[Patch]:
    """Return the replacements for what this platform's event loops wait in, which asyncio takes by these names."""
    waiting: list[Any] = [selectors.DefaultSelector]
    if sys.platform == "win32":
        import asyncio

        waiting.append(asyncio.IocpProactor)
    return [Patch(owner, "select", _in_robot_time(owner.select)) for owner in waiting]


def _in_robot_time(real: Callable[..., list[Any]]) -> Callable[..., list[Any]]:
    def select(self: Any, timeout: float | None = None) -> list[Any]:
        __tracebackhide__ = True
        threads = cooperative.scope.taking_part()
        if threads is None or not cooperative.is_event_loop_of_robot_code(get_frame(1)):
            return real(self, timeout)
        clock = threads.clock
        end_us = None if timeout is None else clock.now_us + max(0, to_us(timeout))
        while not (ready := real(self, 0)):
            next_us = clock.now_us + _POLL_US
            if end_us is not None and clock.now_us >= end_us:
                break
            threads.sleep_until(next_us if end_us is None else min(next_us, end_us))
        return ready

    return select
