"""Threads that still run."""

from __future__ import annotations

import threading
from collections.abc import Iterator

from .part import Part


class Threads(Part):
    """The threads that Python knows."""

    def __init__(self) -> None:
        self._before = set(threading.enumerate())

    def left_over(self) -> Iterator[str]:
        for thread in threading.enumerate():
            if thread not in self._before:
                yield f"the thread {thread.name!r}"
