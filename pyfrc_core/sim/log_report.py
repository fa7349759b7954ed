"""What `pyfrc sim --log` prints without a page: where log and simulation first differ, and what moved the sensors."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..runtime.robot_time import PACKET_US
from ..shell import quoted
from ..wording import counted
from .engine.messages import VALUE
from .engine.past_run import name_of
from .engine.source import Source
from .logs.align import enabled_moments
from .ui.models.wording import clock, differing_texts
from .ui.web.differences import FirstDifference, is_number
from .ui.web.only_in_one import device_of, is_mostly_compared, limits

if TYPE_CHECKING:
    from .log_run import LogRun
    from .ui.web.collector import Collector

#: The most values that differ, and the most sensors, that are named; and of those values, shown with both values.
_MOST_NAMED, _MOST_SHOWN = 8, 20
#: A name of a time that code takes, which may differ in each run.
_DURATION = re.compile(r"time|duration|latency|elapsed|period|(^|[^a-z])(ms|dt|fps)($|[^a-z])", re.IGNORECASE)
_SOURCES = {
    "log": "sensors from the log, whatever today's code does",
    "physics": "sensors from physics",
    "nothing": "sensors that neither the log nor physics move",
    "real time": "simulated in real time, so what depends on them differs in each run",
    "replay": "inputs of subsystems, which only the replay of AdvantageKit or PyKit gives to the code",
}

#: The kinds that are said before the result: what follows from them cannot be compared.
_LIMITS = ("nothing", "real time", "replay")
#: The kinds of which the names are not those of sensors, but what is listed.
_NAMED_ALREADY = ("real time", "replay")


class LogReport:
    """Compares a simulation with the log that drives it.

    :param log: the log that drives the source, and is a branch of it
    :param names_all: whether to name all values that differ, and each sensor by its path
    """

    def __init__(self, source: Source, log: LogRun, names_all: bool = False) -> None:
        from .ui.web.collector import Collector

        self._source, self._end = source, log.end
        self._log, self._most = log.run, None if names_all else _MOST_NAMED
        self._collector: Collector = Collector(source, lambda: None)
        self._collector.start()

    def lines(self) -> Iterator[str]:
        """Yield the result, when the source is closed."""
        collector, runs = self._collector, self._collector.runs
        collector.close()
        while collector.look():  # what came after its last look
            pass
        branch = next((each for each in runs.branches if not each.is_former), None)
        found = None if branch is None else runs.first_difference(branch.number, None)
        only = None if branch is None else runs.only_in_one(branch.number)
        if branch is None or found is None or only is None:
            return
        sensors = runs.sensors(branch.number)
        by_source = sensors if self._most is None else _devices_by_source(sensors)
        said = {kind: self._listed(f"{_SOURCES[kind]}:", names) for kind, names in by_source.items() if names}
        yield from limits(self._log.name, found, only)
        yield from (said.pop(kind) for kind in _LIMITS if kind in said)
        yield from self._differences(found, branch.number, is_mostly_compared(found, only))
        if found.never:
            yield self._listed("in both, but never at the same time:", sorted(map(name_of, found.never)))
        for where, topics in ((f"in {self._log.name} only:", only.there), ("here only:", only.here)):
            if topics:
                yield self._listed(where, (_with_time((each.path, each.time)) for each in topics))
        if found.by.ignored:
            yield self._listed("not compared, as you asked:", found.by.ignored)
        yield from said.values()

    def _differences(self, found: FirstDifference, branch: int, mostly: bool) -> Iterator[str]:
        log, by = self._log, found.by
        how = f"within {by.share * 100:g} % of their range" if by.share else "exactly"
        differing = self._named(found)
        if not found.compared:
            yield f"nothing to compare{self._until()}: {log.name} has no value that the robot's code sets here, too"
            return
        if not differing:
            values = f"{counted(found.compared, 'value')} that {log.name} has, too, {how} the same"
            yield f"{'no difference' if mostly else 'what was compared does not differ'}{self._until()}: {values}"
            yield from self._slight(found)
            return
        path, time = differing[0]
        if found.by_rarity:
            most = len(differing) if self._most is None else _MOST_SHOWN
            shown, others = differing[:most], differing[most:]
            order = ", those that change rarely first" if len(differing) > 1 else ""
            title = f"differs in {counted(len(differing), 'value')}{order}:"
            yield "\n  ".join((title, *(self._moment(found, each) for each in shown)))
        else:
            others = differing[1:]
            there, here = differing_texts(*found.values[path])
            yield f"differs first at {clock(time)}, in {name_of(path)}: {there} in {log.name}, {here} here"
        if any(since <= time for since, _ in by.limits):
            yield "this may come from what cannot be compared"
        if others:
            yield self._listed("then in", self._moments(found, others))
        if path.startswith(VALUE) and is_number(found.values[path][0]) and _DURATION.search(name := name_of(path)):
            yield f"if {name} differs in each run, such as a time that code took: --ignore {quoted(name)}"
        if until := self._until():
            yield f"compared{until}"
        for moment in enabled_moments(log.histories["network"])[1:]:
            yield from self._after(moment + log.offset, differing, branch)
        yield from self._slight(found)

    def _slight(self, found: FirstDifference) -> Iterator[str]:
        """Say what differs by less than what counts as a difference: a changed constant may do no more."""
        if slight := found.sorted_slight():
            yield self._listed(
                "differs slightly, at most by this share of its range:",
                (f"{name_of(path)} ({share * 100:.2g} % at {clock(time)})" for path, share, time in slight),
            )

    def _after(self, enabled: float, named: list[tuple[str, float]], branch: int) -> Iterator[str]:
        """Say what differs again from a later enabling on, of what was equal before it.

        :param named: what has been named, with when it differs first
        """
        before = enabled - PACKET_US / 1_000_000
        first = min(time for _, time in named)
        if before <= first or (found := self._collector.runs.first_difference(branch, None, before)) is None:
            return
        if later := [each for each in self._named(found) if each[1] > before and each not in named]:
            yield self._listed(f"after it was enabled at {clock(enabled)}, in", self._moments(found, later))

    def _until(self) -> str:
        """Return how far the run has come, if that is not the end of the log."""
        snapshot = self._source.snapshot
        reached = 0.0 if snapshot is None else snapshot.time
        is_whole = reached > self._end - PACKET_US / 1_000_000
        return "" if is_whole else f" up to {clock(reached)} of {clock(self._end)}"

    def _named(self, found: FirstDifference) -> list[tuple[str, float]]:
        """Return the values that differ, the earliest first; unless all are named, one for each device at a moment."""
        if self._most is None:
            return found.sorted()
        one_each: dict[object, tuple[str, float]] = {}
        for path, time in found.sorted():
            one_each.setdefault((path if path.startswith(VALUE) else device_of(path), time), (path, time))
        return list(one_each.values())

    def _moments(self, found: FirstDifference, differing: list[tuple[str, float]]) -> Iterator[str]:
        """Return values with when they differ and, if all are named, with what they are then."""
        return map(_with_time if self._most is not None else partial(self._moment, found), differing)

    def _moment(self, found: FirstDifference, moment: tuple[str, float]) -> str:
        there, here = differing_texts(*found.values[moment[0]])
        return f"{_with_time(moment)}: {there} in {self._log.name}, {here} here"

    def _listed(self, what: str, names: Iterable[str]) -> str:
        """Return what is said of some names: in one line, or if all are named, each in a line of its own."""
        names = list(names)
        if self._most is None:
            return "\n  ".join((f"{what.removesuffix(':')}:", *names))
        left_out = len(names) - self._most
        more = f" and {left_out} more (-v names all)" if left_out > 0 else ""
        return f"{what} {', '.join(names[: self._most])}{more}"


def _with_time(moment: tuple[str, float | None]) -> str:
    path, time = moment
    return name_of(path) if time is None else f"{name_of(path)} ({clock(time)})"


def _devices_by_source(sensors: dict[str, list[str]]) -> dict[str, list[str]]:
    """Return the devices of sensors in their order; among those that nothing moves, none of which something moves."""
    found = {
        kind: list(dict.fromkeys(paths if kind in _NAMED_ALREADY else map(device_of, paths)))
        for kind, paths in sensors.items()
    }
    moved = {*found["log"], *found["physics"]}
    return found | {"nothing": [name for name in found["nothing"] if name not in moved]}
