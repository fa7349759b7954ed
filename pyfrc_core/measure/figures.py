"""The data of a profile: the times of each function's calls, and overruns of the period.

Each process has its own figures. They are saved to a file when it ends, and added up.
"""

from __future__ import annotations

import pickle
from array import array
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import ceil
from pathlib import Path
from typing import NamedTuple


class Measurand(NamedTuple):
    """A function whose calls are timed.

    :param kind: ``loop``, ``periodic`` (with its own rate), ``robot``, ``command``, ``subsystem``, ``component`` or
        ``callback``
    :param name: its qualified name, such as ``MyRobot.teleopPeriodic``
    :param place: its file and line, such as ``robot.py:12``; empty when it is not the project's own
    """

    kind: str
    name: str
    place: str


#: The loop of a robot; the functions that it calls are timed separately.
WHOLE_LOOP = Measurand("loop", "the whole loop", "")


class Overrun(NamedTuple):
    """An iteration of the loop that took longer than its period, as in the JSON report.

    :param robot_time_s: the robot time at its start
    :param mode: the driver station's mode
    :param function: the innermost timed function that took at least half of it, else the loop itself
    :param place: the function's file and line
    :param loop_ms: the wall time of the iteration, with the robot time of its waits
    :param function_ms: the same of the function
    :param held_up_ms: the part of it in which the thread neither computed nor waited in robot time: the computer ran
        something else, or robot code waited for something outside the program
    :param period_ms: the loop's period
    :param test: the test in which it happened, if there was one
    """

    robot_time_s: float
    mode: str
    function: str
    place: str
    loop_ms: float
    function_ms: float
    held_up_ms: float
    period_ms: float
    test: str


@dataclass
class Figures:
    """The measurements of one process, or of all.

    :param times: the duration of each call, in nanoseconds: processor time of its thread, and robot time of its waits
    :param period_ns: the period of the robot's loop; 0 if it has not run
    :param overruns: the iterations that took longer than their period
    """

    times: dict[Measurand, array[int]] = field(default_factory=dict)
    period_ns: int = 0
    overruns: list[Overrun] = field(default_factory=list)

    def times_of(self, what: Measurand) -> array[int]:
        """Return the array for the times of a function's calls."""
        return self.times.setdefault(what, array("q"))

    def clear(self) -> None:
        """Delete all measurements; the arrays of times stay the same objects."""
        for times in self.times.values():
            del times[:]
        self.overruns.clear()

    def save(self, file: Path) -> None:
        """Write the figures to a file."""
        file.write_bytes(pickle.dumps(self))


def added_up(files: Iterable[Path]) -> Figures:
    """Return the sum of the figures in these files, one for each process."""
    total = Figures()
    for file in files:
        one: Figures = pickle.loads(file.read_bytes())
        for what, times in one.times.items():
            total.times_of(what).extend(times)
        total.period_ns = max(total.period_ns, one.period_ns)
        total.overruns += one.overruns
    return total


@dataclass(frozen=True)
class Distribution:
    """The distribution of a function's times, as in the JSON report; percentiles by the nearest rank."""

    count: int
    p50_ms: float
    p95_ms: float
    p99_ms: float
    max_ms: float
    total_ms: float


def distribution(times: array[int]) -> Distribution:
    """Return the distribution of times in nanoseconds, of which there is at least one."""
    ordered = sorted(times)
    p50, p95, p99 = (ordered[ceil(share * len(ordered)) - 1] / 1e6 for share in (0.5, 0.95, 0.99))
    return Distribution(len(ordered), p50, p95, p99, ordered[-1] / 1e6, sum(ordered) / 1e6)
