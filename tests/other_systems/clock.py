"""Windows' clocks, which go in steps of 1/64 s: `time.monotonic` and `time.time`. `time.perf_counter` does not."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

_STEP_NS = 15_625_000
_get_clock_info = time.get_clock_info


class _Stepped:
    """A clock in steps; unlike a function in Python, it does not become a method in a class."""

    def __init__(self, real_ns: Callable[[], int], unit: Callable[[int], Any], name: str) -> None:
        self._real_ns = real_ns
        self._unit = unit
        self.__name__ = self.__qualname__ = name

    def __call__(self) -> Any:
        now = self._real_ns()
        return self._unit(now - now % _STEP_NS)


def install() -> None:
    """Replace the clocks."""
    for name in ("monotonic", "time"):
        real_ns = getattr(time, f"{name}_ns")
        setattr(time, name, _Stepped(real_ns, lambda now: now / 1e9, name))
        setattr(time, f"{name}_ns", _Stepped(real_ns, int, f"{name}_ns"))
    time.get_clock_info = _clock_info  # type: ignore[assignment]


def _clock_info(name: Any) -> Any:
    info = _get_clock_info(name)
    return SimpleNamespace(**{**vars(info), "resolution": _STEP_NS / 1e9}) if name in ("monotonic", "time") else info
