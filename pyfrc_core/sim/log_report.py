"""What `pyfrc sim --log` prints without a page: where log and simulation first differ, and what moved the sensors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import TYPE_CHECKING

from ..hal.paths import format_path, parse_path
from ..runtime.scripts.sensors import camera_of
from ..wording import counted
from .engine.messages import VALUE
from .engine.past_run import PastRun
from .engine.source import Source
from .ui.models.wording import clock

if TYPE_CHECKING:
    from .ui.web.collector import Collector
    from .ui.web.differences import FirstDifference

#: The most values that differ, and the most sensors, that are named.
_MOST_NAMED = 8
_SOURCES = {
    "log": "sensors from the log",
    "physics": "sensors from physics",
    "nothing": "sensors that neither the log nor physics move",
    "replay": "inputs of subsystems, which only the replay of AdvantageKit or PyKit gives to the code",
}


class LogReport:
    """Compares a simulation with the log that drives it.

    :param log: the branch of the source that is the log
    """

    def __init__(self, source: Source, log: PastRun) -> None:
        from .ui.web.collector import Collector

        self._log = log
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
        if branch is None or found is None:
            return
        yield from self._differences(found, branch.number)
        for kind, paths in runs.sensors(branch.number).items():
            if paths:
                yield f"{_SOURCES[kind]}: {_listed(paths if kind == 'replay' else _devices(paths))}"

    def _differences(self, found: FirstDifference, branch: int) -> Iterator[str]:
        log, runs = self._log, self._collector.runs
        by = found.by
        how = f"within {by.share * 100:g} % of their range" if by.share else "exactly"
        differing = found.sorted()
        if not found.compared:
            yield f"nothing to compare: {log.name} has no value that the robot's code sets here, too"
            return
        if not differing:
            yield f"no difference: {counted(found.compared, 'value')} that {log.name} has, too, {how} the same"
            return
        (path, time), *others = differing
        here, there = (_short((runs.values_at(time, number) or {}).get(path)) for number in (None, branch))
        yield f"differs first at {clock(time)}, in {name_of(path)}: {there} in {log.name}, {here} here"
        if others:
            yield "then in " + _listed([f"{name_of(path)} ({clock(time)})" for path, time in others])


def name_of(path: str) -> str:
    """Return the name of a value for people."""
    return path.removeprefix(f"{VALUE}/SmartDashboard/").removeprefix(f"{VALUE}/")


def _devices(paths: Iterable[str]) -> list[str]:
    """Return the devices of some sensors, in their order."""
    found: dict[str, None] = {}
    for path in paths:
        if (camera := camera_of(path.removeprefix(VALUE))) is not None:
            found[camera] = None
            continue
        segments = parse_path(path)
        found[str(segments[1]) if segments[0] == "CAN" else format_path(segments[:-1] or segments)] = None
    return list(found)


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - _MOST_NAMED} more" if len(names) > _MOST_NAMED else ""
    return ", ".join(islice(names, _MOST_NAMED)) + more


def _short(value: object) -> str:
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
