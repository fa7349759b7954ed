"""Why this process cannot be forked: what importing the project's code has made, and a fork would lack."""

from __future__ import annotations

import threading

from ..compat.cpython_private import target_of
from ..hal import devices_exist, existing_devices
from .cooperative import threads_of_the_project

_NAMED_DEVICES = 3


def reasons_not_to_fork() -> list[str]:
    """Return what the project's code has made in this process and a fork of it would lack: threads and devices."""
    reasons = [f"{line} starts {_described(thread)}" for thread, line in threads_of_the_project()]
    if devices_exist():
        devices = existing_devices()
        more = f" and {len(devices) - _NAMED_DEVICES} more" if len(devices) > _NAMED_DEVICES else ""
        reasons.append(f"devices are made: {', '.join(devices[:_NAMED_DEVICES])}{more}")
    return reasons


def _described(thread: threading.Thread) -> str:
    target = target_of(thread) or type(thread)
    name = getattr(target, "__qualname__", type(thread).__qualname__)
    module = getattr(target, "__module__", None)
    return f"the thread {thread.name!r}, which runs {module}.{name}" if module else f"the thread {thread.name!r}"
