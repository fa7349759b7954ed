"""When logs of different clocks show the same moment: what is added to the times of one to show it beside another."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

from ..engine.messages import MODE
from ..engine.value_history import MISSING, ValueHistory

#: By what logs are aligned: the first enabling, the beginning of the match, or the beginning of the logs.
Align = Literal["enabled", "match", "start"]


def moment_of(network: ValueHistory, align: Align) -> float | None:
    """Return the moment by which a run is aligned, in its seconds; None if it has none.

    A match begins with the last autonomous that is followed by teleop, or else where the robot was first enabled.

    :param network: the values with the mode
    """
    if align == "start":
        return 0.0
    enabled = [(time, mode) for time, mode in modes_of(network) if not mode.startswith("disabled")]
    if align == "match":
        found = [time for (time, mode), (_, after) in pairwise(enabled) if mode == "autonomous" and after == "teleop"]
        if found:
            return found[-1]
    return enabled[0][0] if enabled else None


def enabled_moments(network: ValueHistory) -> list[float]:
    """Return the moments at which a robot that was disabled is enabled, in the run's seconds."""
    modes = [(0.0, "disabled"), *modes_of(network)]
    return [
        time
        for (_, before), (time, mode) in pairwise(modes)
        if before.startswith("disabled") and not mode.startswith("disabled")
    ]


def offset_of(network: ValueHistory, beside: ValueHistory, align: Align) -> float | None:
    """Return what is added to the times of one run to show it beside another; None if one of them lacks the moment."""
    own, other = moment_of(network, align), moment_of(beside, align)
    return None if own is None or other is None else round(other - own, 6)


def modes_of(network: ValueHistory) -> list[tuple[float, str]]:
    """Return when a run entered each of its modes."""
    times, values = network.changes(MODE)
    return [(time, str(value)) for time, value in zip(times, values, strict=True) if value is not MISSING]
