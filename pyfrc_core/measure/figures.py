"""What a profile is made of: how long each function took each time, where the period was overrun, which lines ran.

Each process of a run has figures of its own, which are kept in a file when it ends, and added up.
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

    :param kind: what it is: ``loop``, ``periodic`` (with a rate of its own), ``robot``, ``command``, ``subsystem``,
        ``component`` or ``callback``
    :param name: as its code calls it, such as ``MyRobot.teleopPeriodic``
    :param place: its file and line, such as ``robot.py:12``; empty when it is not the project's own
    """

    kind: str
    name: str
    place: str


class Line(NamedTuple):
    """A line of the robot's code, and the function that it is in."""

    place: str
    function: str


class Overrun(NamedTuple):
    """A turn of the loop that took longer than its period.

    :param seconds: the robot time at which it began
    :param mode: the driver station's mode
    :param culprit: the innermost timed function in which at least half of it was spent, else the loop itself
    :param took_ns: how long the turn took
    :param culprit_ns: how long the culprit took
    :param held_up_ns: how much of that its thread neither computed nor waited in robot time: the computer did
        something else, or the robot's code waited for the world outside
    :param period_ns: how long it may have taken
    :param test: the test in which it happened, if it was in one
    """

    seconds: float
    mode: str
    culprit: Measurand
    took_ns: int
    culprit_ns: int
    held_up_ns: int
    period_ns: int
    test: str


@dataclass
class Figures:
    """What was measured, in one process or in all of them.

    :param times: how long each call took, in nanoseconds
    :param lines: the time that each line was the innermost one of the robot's: computing, and waiting in robot time
        within a timed function; in nanoseconds
    :param stacks: the time for each stack of calls, outermost first, each a function, its file and the line in it
    :param samples: how many samples lines and stacks are from
    :param sampling_ns: how long taking them took
    """

    times: dict[Measurand, array[int]] = field(default_factory=dict)
    overruns: list[Overrun] = field(default_factory=list)
    lines: dict[Line, list[int]] = field(default_factory=dict)
    stacks: dict[tuple[tuple[str, str, int], ...], int] = field(default_factory=dict)
    samples: int = 0
    sampling_ns: int = 0

    def times_of(self, what: Measurand) -> array[int]:
        """The list that the times of its calls go to."""
        return self.times.setdefault(what, array("q"))

    def on_line(self, line: Line, computing_ns: int, waiting_ns: int) -> None:
        """The robot's code was there for so long."""
        spent = self.lines.setdefault(line, [0, 0])
        spent[0] += computing_ns
        spent[1] += waiting_ns

    def forget(self) -> None:
        """Begin anew; the lists of times stay the same objects."""
        for times in self.times.values():
            del times[:]
        self.overruns.clear()
        self.lines.clear()
        self.stacks.clear()
        self.samples = self.sampling_ns = 0

    def add(self, others: Figures) -> None:
        """Add what was measured elsewhere."""
        for what, times in others.times.items():
            self.times_of(what).extend(times)
        self.overruns += others.overruns
        for line, (computing, waiting) in others.lines.items():
            self.on_line(line, computing, waiting)
        for stack, spent in others.stacks.items():
            self.stacks[stack] = self.stacks.get(stack, 0) + spent
        self.samples += others.samples
        self.sampling_ns += others.sampling_ns

    def keep(self, file: Path) -> None:
        """Write them to a file."""
        file.write_bytes(pickle.dumps(self))


def added_up(files: Iterable[Path]) -> Figures:
    """The figures of all processes, each kept in one of these files."""
    total = Figures()
    for file in files:
        total.add(pickle.loads(file.read_bytes()))
    return total


@dataclass(frozen=True)
class Distribution:
    """How the times of a function's calls are distributed; in milliseconds, percentiles by the nearest rank."""

    count: int
    p50: float
    p95: float
    p99: float
    longest: float
    total: float


def distribution(times: array[int]) -> Distribution:
    """The distribution of times in nanoseconds, of which there is at least one."""
    ordered = sorted(times)

    def percentile(share: float) -> float:
        return ordered[max(0, ceil(share * len(ordered)) - 1)] / 1e6

    return Distribution(
        len(ordered), percentile(0.5), percentile(0.95), percentile(0.99), ordered[-1] / 1e6, sum(ordered) / 1e6
    )
