"""The data of a profile: the times of each function's calls, overruns of the period, and the lines that ran.

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


class CodeLine(NamedTuple):
    """A line of the robot's code.

    :param place: its file and line, such as ``robot.py:12``
    :param function: the name of the function with this line
    """

    place: str
    function: str


class Overrun(NamedTuple):
    """An iteration of the loop that took longer than its period.

    :param seconds: the robot time at its start
    :param mode: the driver station's mode
    :param culprit: the innermost timed function that took at least half of it, else the loop itself
    :param took_ns: the wall time of the iteration, with the robot time of its waits
    :param culprit_ns: the same of the culprit
    :param held_up_ns: the part of it in which the thread neither computed nor waited in robot time: the computer ran
        something else, or robot code waited for something outside the program
    :param period_ns: the loop's period
    :param test: the test in which it happened, if there was one
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
    """The measurements of one process, or of all.

    :param times: the duration of each call, in nanoseconds: processor time of its thread, and robot time of its waits
    :param period_ns: the period of the robot's loop; 0 if it has not run
    :param overruns: the iterations that took longer than their period
    :param lines: for each line the time in which it was the robot's innermost one: computing, and waiting in robot time
        within a timed function, both in nanoseconds
    :param stacks: the time of each call stack, outermost first; each entry is a function, its file and its current line
    :param samples: the number of samples behind `lines` and `stacks`
    :param sampling_ns: the time that sampling took
    """

    times: dict[Measurand, array[int]] = field(default_factory=dict)
    period_ns: int = 0
    overruns: list[Overrun] = field(default_factory=list)
    lines: dict[CodeLine, list[int]] = field(default_factory=dict)
    stacks: dict[tuple[tuple[str, str, int], ...], int] = field(default_factory=dict)
    samples: int = 0
    sampling_ns: int = 0

    def times_of(self, what: Measurand) -> array[int]:
        """Return the array for the times of a function's calls."""
        return self.times.setdefault(what, array("q"))

    def on_line(self, line: CodeLine, computing_ns: int, waiting_ns: int) -> None:
        """Add time to a line."""
        spent = self.lines.setdefault(line, [0, 0])
        spent[0] += computing_ns
        spent[1] += waiting_ns

    def clear(self) -> None:
        """Delete all measurements; the arrays of times stay the same objects."""
        for times in self.times.values():
            del times[:]
        self.overruns.clear()
        self.lines.clear()
        self.stacks.clear()
        self.samples = self.sampling_ns = 0

    def add(self, others: Figures) -> None:
        """Add the measurements of another process."""
        for what, times in others.times.items():
            self.times_of(what).extend(times)
        self.period_ns = max(self.period_ns, others.period_ns)
        self.overruns += others.overruns
        for line, (computing, waiting) in others.lines.items():
            self.on_line(line, computing, waiting)
        for stack, spent in others.stacks.items():
            self.stacks[stack] = self.stacks.get(stack, 0) + spent
        self.samples += others.samples
        self.sampling_ns += others.sampling_ns

    def save(self, file: Path) -> None:
        """Write the figures to a file."""
        file.write_bytes(pickle.dumps(self))


def added_up(files: Iterable[Path]) -> Figures:
    """Return the sum of the figures in these files, one for each process."""
    total = Figures()
    for file in files:
        total.add(pickle.loads(file.read_bytes()))
    return total


@dataclass(frozen=True)
class Distribution:
    """The distribution of a function's times, in milliseconds; percentiles by the nearest rank."""

    count: int
    p50: float
    p95: float
    p99: float
    longest: float
    total: float


def distribution(times: array[int]) -> Distribution:
    """Return the distribution of times in nanoseconds, of which there is at least one."""
    ordered = sorted(times)

    def percentile(share: float) -> float:
        return ordered[max(0, ceil(share * len(ordered)) - 1)] / 1e6

    return Distribution(
        len(ordered), percentile(0.5), percentile(0.95), percentile(0.99), ordered[-1] / 1e6, sum(ordered) / 1e6
    )
