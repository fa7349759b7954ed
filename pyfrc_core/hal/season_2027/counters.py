"""Counters: WPILib 2027 has none that `hal_data` shows; its `EdgeCounter` always returns 0 in the simulated HAL."""

from __future__ import annotations


def counted_channels() -> frozenset[int]:
    """Return the channels of the digital inputs whose edges counters of the robot count."""
    return frozenset()


def forget_written_counts() -> None:
    """Forget what was written for counters that the robot's code does not have."""
