"""The cost of measuring, determined on this machine: the part of a profile's times that is not the robot's own."""

from __future__ import annotations

import cProfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import thread_time
from timeit import repeat

from ..project.robot_files import RobotFiles
from .figures import Figures, Measurand
from .stopwatch import Stopwatch

_CALLS, _ROUNDS = 2000, 7


@dataclass(frozen=True)
class Cost:
    """The cost of measuring, in nanoseconds.

    :param call_ns: the cost of timing one call
    :param timing_ns: the cost of timing all calls
    :param sampling_ns: the cost of all samples
    :param profiled_calls: how many calls `cProfile` has recorded; 0 if it was not used
    :param calls_ns: the cost of recording them
    :param robot_ns: the time of `robotInit` and all iterations of the loop, with the cost of measuring
    """

    call_ns: float
    timing_ns: float
    sampling_ns: float
    profiled_calls: int
    calls_ns: float
    robot_ns: float

    @property
    def share(self) -> float | None:
        """The cost relative to the time without it: 0.1 is a tenth. None when there was no iteration."""
        total = self.timing_ns + self.sampling_ns + self.calls_ns
        alone = self.robot_ns - total
        return total / alone if self.robot_ns and alone > 0 else None


def _is_outermost(what: Measurand) -> bool:
    return what.kind in ("loop", "periodic") or what.name.endswith(".robotInit")


class _Robot:
    def periodic(self) -> None:
        """Do nothing: this is timed to determine the cost of timing."""


def measured_cost(figures: Figures, profiled_calls: int) -> Cost:
    """Return the cost of measuring these figures.

    :param profiled_calls: how many calls `cProfile` has recorded
    """
    robot = _Robot()
    bare = _seconds(lambda: _Robot.periodic(robot))
    timed = Stopwatch(Figures(), RobotFiles(Path())).timed(_Robot.periodic, Measurand("robot", "", ""))
    call_ns = max(0.0, _seconds(lambda: timed(robot)) - bare) * 1e9
    count = sum(len(times) for times in figures.times.values())
    return Cost(
        call_ns,
        count * call_ns,
        figures.sampling_ns,
        profiled_calls,
        # Each run makes two calls: of the lambda, and of the method.
        profiled_calls * max(0.0, _profiled_seconds(robot) - bare) / 2 * 1e9 if profiled_calls else 0.0,
        sum(sum(times) for what, times in figures.times.items() if _is_outermost(what)),
    )


def _seconds(call: Callable[[], object]) -> float:
    """Return the duration of a call: the minimum of several rounds, since other programs can only add to it."""
    return min(repeat(call, timer=thread_time, number=_CALLS, repeat=_ROUNDS)) / _CALLS


def _profiled_seconds(robot: _Robot) -> float:
    profile = cProfile.Profile()
    profile.enable()
    try:
        return _seconds(lambda: _Robot.periodic(robot))
    finally:
        profile.disable()
