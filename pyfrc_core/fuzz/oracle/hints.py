"""What is no failure, but may be a mistake: it is noted in each match, and shown once at the end of a campaign."""

from __future__ import annotations

import re
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

from ...project.robot_files import RobotFiles
from ...runtime.clock import PACKET_US
from ...runtime.exceptions import TestEnded, TestFroze
from ...runtime.robot import RobotRun
from ...runtime.threads.cooperative import line_of_thread
from ...season import CURRENT
from ...wording import counted
from .growth import NETWORK_TABLES, Containers, Growth, Growths
from .unfinished_commands import UnfinishedCommands

#: How many loops of a match may take long: Python collects garbage in some, and reads modules in others.
_SLOW_AT_TIMES = 5

#: For so long, the robot may still be importing modules.
_FIRST_US = 1_000_000

# Bound before `runtime.patches.install` replaces the name.
_processor_time = time.thread_time


@dataclass(frozen=True)
class MatchHints:
    """What one match shows.

    :param growths: what only grew
    :param unfinished: the commands that ran for long, and for how long, in microseconds
    :param finished: the commands that ended because they were finished
    :param loop_seconds: the processor time of a long loop; a few loops took longer
    :param period: the period of these loops, in seconds
    :param threads: those that did not end with the robot program: where each was, and its name
    """

    growths: tuple[Growth, ...] = ()
    unfinished: dict[str, int] = field(default_factory=dict)
    finished: frozenset[str] = frozenset()
    loop_seconds: float = 0.0
    period: float = PACKET_US / 1_000_000
    threads: tuple[tuple[str, str], ...] = ()

    def with_those_before(self, before: MatchHints) -> MatchHints:
        """Return the hints of a match whose robot program has started again. Threads are those at its end."""
        growths = {each.name: each for each in (*before.growths, *self.growths)}
        longest = Counter(self.unfinished) | Counter(before.unfinished)
        return replace(
            self,
            growths=tuple(growths.values()),
            unfinished=dict(longest),
            finished=self.finished | before.finished,
            loop_seconds=max(self.loop_seconds, before.loop_seconds),
        )


def threads_left(run: RobotRun) -> tuple[tuple[str, str], ...]:
    """End the robot program of a match that is over, if Python would wait for its threads; return those that remain."""
    if not run.threads.must_end:
        return ()
    with suppress(Exception, TestEnded, TestFroze):
        run.end()
    places = (record.left_at or line_of_thread(record.ident) or "" for record in run.still_running)
    names = (record.thread.name if record.thread is not None else "?" for record in run.still_running)
    return tuple(zip(places, names, strict=True))


class LoopTimes:
    """Measures the processor time of loops of a `TimedRobot`, which has been started."""

    def __init__(self, run: RobotRun) -> None:
        self._longest: list[float] = [0.0] * (_SLOW_AT_TIMES + 1)
        self.period = PACKET_US / 1_000_000
        if (main := run.timed_loop.main) is not None:
            self.period = main.period_us / 1_000_000
            main.call = self._measured(main.call)

    @property
    def seconds(self) -> float:
        """Return the time that only a few loops exceeded."""
        return self._longest[-1]

    def _measured(self, call: Callable[[], Any]) -> Callable[[], Any]:
        processor_time = _processor_time

        def measured() -> None:
            __tracebackhide__ = True
            began = processor_time()
            call()
            took = processor_time() - began
            if took > self._longest[-1]:
                self._longest[-1] = took
                self._longest.sort(reverse=True)

        return measured


class HintWatch:
    """Watches one match for hints.

    :param containers: see `Growths`
    """

    def __init__(self, run: RobotRun, files: RobotFiles, containers: Containers) -> None:
        self._run = run
        self._growths = Growths(containers)
        self._commands = UnfinishedCommands(run.clock, files)
        self._loops: LoopTimes | None = None
        #: `after_packet` does nothing before this time.
        self.next_us = 0

    def measure_loops(self) -> None:
        """Measure loops from now on; the robot has been started."""
        self._loops = LoopTimes(self._run)

    def after_packet(self, now_us: int) -> None:
        """Look at the robot once in each packet."""
        self._growths.after_packet(now_us)
        awaits_commands = "commands2" in sys.modules and not self._commands.watching
        if awaits_commands:
            self._commands.begin()
        # Robots import commands2 with their modules; it is looked for in the first second, and now and then.
        self.next_us = 0 if awaits_commands or now_us < _FIRST_US else self._growths.next_us

    def hints(self) -> MatchHints:
        """Return what the match shows; it is over."""
        commands = self._commands
        commands.end()
        found = MatchHints(tuple(self._growths.found()), commands.longest, frozenset(commands.finished))
        loops = self._loops
        return found if loops is None else replace(found, loop_seconds=loops.seconds, period=loops.period)


# -- of a campaign ---------------------------------------------------------------------------------------------------

#: In how many matches something must show.
_LEAST_MATCHES = 5


class CampaignHints:
    """Collects the hints of matches, in the order of their numbers."""

    def __init__(self) -> None:
        self._growths: dict[str, list[Growth]] = {}
        self._unfinished: dict[str, list[int]] = {}
        self._finished: set[str] = set()
        self._slow: list[MatchHints] = []
        self._threads: Counter[tuple[str, str]] = Counter()
        #: The places that set an output in each disabled loop.
        self.always_set: list[str] = []
        #: How many starts of the robot there were, how many failed by each cause, and the failures that did not repeat.
        self.starts = 0
        self.failed_starts: Counter[str] = Counter()
        self.unsteady: dict[str, str] = {}

    def add(self, hints: MatchHints) -> None:
        """Add what a match shows."""
        self.starts += 1
        for growth in hints.growths:
            self._growths.setdefault(growth.name, []).append(growth)
        for name, ran_us in hints.unfinished.items():
            self._unfinished.setdefault(name, []).append(ran_us)
        self._finished |= hints.finished
        # One that has no name of its own is numbered: another number in each match, for the same line.
        self._threads.update({(place, re.sub(r"^Thread-\d+", "Thread", name)) for place, name in hints.threads})
        if hints.loop_seconds > hints.period:
            self._slow.append(hints)

    def texts(self) -> Iterator[str]:
        """Yield each hint in words."""
        for cause, text in self.unsteady.items():
            yield f"{text} (at {self.failed_starts[cause]} of {self.starts} starts, and not again with the same inputs)"
        for place in self.always_set:
            yield (
                f"{place}: this sets an output in each loop while the robot is disabled, from the first one on. "
                "That is as it should be for lights; a motor would move as soon as the robot is enabled"
            )
        for name, growths in sorted(self._growths.items()):
            if len(growths) >= _LEAST_MATCHES:
                what = "NetworkTables only grow" if name == NETWORK_TABLES else f"robot.{name} only grows"
                shown = sorted(growths, key=lambda growth: growth.per_second)[len(growths) // 2]
                yield (
                    f"{what}: by about {shown.per_second:.0f} elements a second, to {shown.size} at the "
                    f"end of a match ({counted(len(growths), 'match', 'matches')})"
                )
        for name, times in sorted(self._unfinished.items()):
            if len(times) >= _LEAST_MATCHES and name not in self._finished:
                yield (
                    f"{name} was never true: the command ran for up to {max(times) / 1e6:.0f} s "
                    f"({counted(len(times), 'match', 'matches')})"
                )
        for (place, name), matches in sorted(self._threads.items()):
            if matches >= _LEAST_MATCHES:
                yield (
                    f"{place}: the thread {name!r} does not end with the robot program "
                    f"({counted(matches, 'match', 'matches')}): end it in endCompetition, or make it a daemon"
                )
        if len(self._slow) >= _LEAST_MATCHES:
            slow = sorted(self._slow, key=lambda hints: hints.loop_seconds)[len(self._slow) // 2]
            yield (
                f"several loops of a match need {slow.loop_seconds * 1000:.0f} ms of processor time or more on this "
                f"computer, and a period is {slow.period * 1000:.0f} ms "
                f"({counted(len(self._slow), 'match', 'matches')}): a {CURRENT.controller.name} needs longer"
            )
