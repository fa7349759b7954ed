"""The condition that wakes front ends: none of its notifications is missed."""

from __future__ import annotations

import threading

from pyfrc_core.sim.engine.changes import ReportSignal

#: A time limit that is never reached, in seconds.
PATIENCE = 60.0


def test_a_notification_before_the_wait_ends_it() -> None:
    signal = ReportSignal()
    seen = signal.count
    with signal:
        signal.notify_all()
    signal.wait_after(seen, PATIENCE)
    assert signal.count == seen + 1


def test_a_notification_ends_a_wait() -> None:
    signal = ReportSignal()
    waiting = threading.Thread(target=signal.wait_after, args=(signal.count, PATIENCE))
    waiting.start()
    with signal:
        signal.notify_all()
    waiting.join(PATIENCE)
    assert not waiting.is_alive()
