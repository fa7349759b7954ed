"""What measuring costs, measured on this machine: what of a profile's figures is not the robot's own."""

from __future__ import annotations

import cProfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from timeit import repeat

from ..project.robot_files import RobotFiles
from .figures import Figures, Measurand
from .stopwatch import Stopwatch

_CALLS, _ROUNDS = 2000, 7


@dataclass(frozen=True)
class Cost:
    """What measuring has cost, in nanoseconds.

    :param call_ns: the cost of timing one call
    :param timing_ns: that of all calls
    :param sampling_ns: that of all samples
    :param calls_ns: that of `cProfile`, if it was wanted
    :param robot_ns: how long `robotInit` and all turns of the loop took together, with what measuring cost within
    """

    call_ns: float
    timing_ns: float
    sampling_ns: float
    calls_ns: float
    robot_ns: float

    @property
    def share(self) -> float | None:
        """How much longer they took, by what was measured of it: 0.1 is a tenth. None when there were none."""
        total = self.timing_ns + self.sampling_ns + self.calls_ns
        alone = self.robot_ns - total
        return total / alone if self.robot_ns and alone > 0 else None


def _is_outermost(what: Measurand) -> bool:
    return what.kind in ("loop", "periodic") or what.name.endswith(".robotInit")


class _Robot:
    def periodic(self) -> None:
        """What is timed to find out what timing costs."""


def measured_cost(figures: Figures, profiled_calls: int) -> Cost:
    """What it has cost to measure these figures.

    :param profiled_calls: how many calls `cProfile` has seen
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
        profiled_calls * max(0.0, _profiled_seconds(robot) - bare) * 1e9 if profiled_calls else 0.0,
        sum(sum(times) for what, times in figures.times.items() if _is_outermost(what)),
    )


def _seconds(call: Callable[[], object]) -> float:
    """How long a call takes: the least of several rounds, since whatever else the machine does only adds to it."""
    return min(repeat(call, number=_CALLS, repeat=_ROUNDS)) / _CALLS


def _profiled_seconds(robot: _Robot) -> float:
    profile = cProfile.Profile()
    profile.enable()
    try:
        # Two calls each: of the lambda, and of the method.
        return _seconds(lambda: _Robot.periodic(robot)) / 2
    finally:
        profile.disable()
