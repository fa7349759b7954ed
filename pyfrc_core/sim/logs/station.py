"""A log of the driver station on the time line of a robot's log of the same time.

Their clocks have nothing in common but the time of day, which a robot gets from the driver station's computer. But both
say when the robot was enabled and disabled, to about a packet. All matches last equally long, so that alone does not
tell one match from another: where both have the time of day, it must agree, too. What is known by the time of day alone
is called that.
"""

from __future__ import annotations

import statistics
from bisect import bisect_left
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from datetime import timedelta
from itertools import pairwise
from typing import NamedTuple

from ...wording import counted
from ..engine.messages import MODE, VALUE
from ..engine.past_run import Happened, PastRun
from ..engine.value_history import MISSING, ValueHistory
from .columns import Column, ReadLog
from .ds_log import CONNECTED
from .layout import first_moment, run_of, when_of
from .open import OpenedLog

#: How far apart both logs may have the same enabling, in seconds: a lost packet, and the driver station's own timer.
_NEAR = 0.25
#: How far apart the times of day of both may be, in seconds: a robot gets it when the driver station connects.
_SAME_TIME = 60.0
#: How many ways to put one beside the other are looked at closely.
_MOST_WAYS = 20


class Alignment(NamedTuple):
    """How a log of the driver station fits to a robot's log.

    :param offset: what is added to its times, in seconds; None: it does not fit, or that is not known
    :param how: how that is known, or why not; a clause for people
    """

    offset: float | None
    how: str


class _Way(NamedTuple):
    """A way to put one beside the other.

    :param matched: how many enablings and disablings they have in common, within `spread` seconds
    """

    offset: float
    matched: int
    spread: float


def align(robot: OpenedLog, station: OpenedLog) -> Alignment:
    """Return how a log of the driver station fits to a robot's log."""
    if all(each.read is not None and CONNECTED in each.read.columns for each in (robot, station)):
        return Alignment(None, "there is one log of the driver station already")
    clocks = _offset_of_clocks(robot, station)
    ways = [way for way in _ways(robot.run, station.run) if _agrees(robot.run, station.run, way)]
    if clocks is not None:
        return _by_clocks(robot.run, station.run, clocks, ways)
    ways = [way for way in ways if way.matched > 1]
    if not ways:
        return Alignment(
            None, "no enablings and disablings of both fit together, and one does not have the time of day"
        )
    best = max(ways, key=lambda way: way.matched)
    if _is_ambiguous(best, ways):
        return Alignment(None, "its enablings fit in several places, and one does not have the time of day")
    doubt = "; one does not have the time of day, so another match would fit, too"
    return Alignment(best.offset, _matched(best) + doubt)


def _by_clocks(robot: PastRun, station: PastRun, clocks: float, ways: list[_Way]) -> Alignment:
    """Return how they fit, where both have the time of day.

    :param clocks: what is added to the station's times so that both show the same time of day
    """
    near = [way for way in ways if abs(way.offset - clocks) <= _SAME_TIME]
    best = max(near, key=lambda way: way.matched, default=None)
    if best is not None and not _is_ambiguous(best, near):
        return Alignment(best.offset, f"{_matched(best)}, and the time of day within {abs(best.offset - clocks):.1f} s")
    if clocks > robot.end or clocks + station.end < 0:
        apart = timedelta(seconds=round(clocks - robot.end if clocks > 0 else -clocks - station.end))
        return Alignment(None, f"by the time of day, there are {apart} between them")
    several = "its enablings fit in several places"
    if not _agrees(robot, station, _Way(clocks, 1, 0.0)):
        unlike = "at the same time of day, the robot is enabled in one of them and disabled in the other"
        return Alignment(None, unlike if best is None else f"{several} near the same time of day")
    why = "no enabling says more" if best is None else several
    return Alignment(clocks, f"by the time of day alone, which may be up to {_SAME_TIME:.0f} s wrong: {why}")


def _is_ambiguous(best: _Way, ways: list[_Way]) -> bool:
    """Return whether another way fits as well."""
    return any(way.matched == best.matched and abs(way.offset - best.offset) > _NEAR for way in ways)


def _matched(way: _Way) -> str:
    return (
        f"{counted(way.matched, 'enabling or disabling', 'enablings and disablings')} agree within {way.spread:.2f} s"
    )


def _offset_of_clocks(robot: OpenedLog, station: OpenedLog) -> float | None:
    """Return what is added to the station's times so that both have the same time of day; None if one lacks it."""
    if robot.read is None or station.read is None:
        return None
    own, other = when_of(robot.read), when_of(station.read)
    return None if own is None or other is None else (other - own).total_seconds()


def _ways(robot: PastRun, station: PastRun) -> Iterator[_Way]:
    """Yield the offsets at which they have most enablings and disablings in common."""
    own, other = _edges(robot.histories["network"]), _edges(station.histories["network"])
    votes = Counter(round((time - there) / _NEAR) for time, on in own for there, is_on in other if on == is_on)
    for vote, _ in votes.most_common(_MOST_WAYS):
        apart = []
        for time, on in own:
            shifted = [there for there, is_on in other if on == is_on]
            place = bisect_left(shifted, time - (vote + 1) * _NEAR)
            if place < len(shifted) and time - shifted[place] >= (vote - 1) * _NEAR:
                apart.append(time - shifted[place])
        if apart:
            offset = statistics.median(apart)
            near = [each - offset for each in apart if abs(each - offset) <= _NEAR]
            yield _Way(round(offset, 6), len(near), max(map(abs, near), default=0.0))


def _edges(network: ValueHistory) -> list[tuple[float, bool]]:
    """Return when the robot was enabled and disabled; what happened while that was not known has no moment."""
    return [
        (time, state)
        for (_, before), (time, state) in pairwise(_states(network))
        if state is not None and before is (not state)
    ]


def _states(network: ValueHistory) -> list[tuple[float, bool | None]]:
    """Return since when it is known that the robot is enabled or disabled; None: it is not."""
    connected = network.changes(VALUE + CONNECTED)
    modes = network.changes(MODE)
    times = sorted({*modes[0], *connected[0]})
    return [(time, _state_at(network, time)) for time in times]


def _state_at(network: ValueHistory, time: float) -> bool | None:
    mode = network.value_at(MODE, time + 1e-6)
    if mode is MISSING or network.value_at(VALUE + CONNECTED, time + 1e-6) is False:
        return None
    return not str(mode).startswith("disabled")


def _agrees(robot: PastRun, station: PastRun, way: _Way) -> bool:
    """Return whether they say the same of the robot wherever both know it, but for moments around what they share."""
    own, other = robot.histories["network"], station.histories["network"]
    begin, end = max(way.offset, 0.0), min(robot.end, station.end + way.offset)
    times = [time for time, _ in _states(own)] + [time + way.offset for time, _ in _states(other)]
    moments = [begin, *sorted(time for time in times if begin < time < end), end]
    differing = 0.0
    for before, after in pairwise(moments):
        here, there = _state_at(own, before), _state_at(other, before - way.offset)
        if here is not None and there is not None and here != there:
            differing += after - before
    return begin < end and differing <= _NEAR * way.matched


# -- one line ---------------------------------------------------------------------------------------------------------


def join(robot: OpenedLog, station: OpenedLog, alignment: Alignment, height: float) -> OpenedLog:
    """Return a robot's log with the driver station's log in it. Where one of them has ended, its values are gone.

    :param alignment: what `align` has found; it has an offset
    :param height: that of the field, in feet
    """
    read, other = robot.read, station.read
    assert read is not None
    assert other is not None
    assert alignment.offset is not None
    by = round(alignment.offset * 1e6) + first_moment(read) - first_moment(other)
    shifted = {name: replace(column, moments=column.moments_later(by)) for name, column in other.columns.items()}
    ends = [_end(columns) for columns in (read.columns, shifted)]
    columns = {
        name: column.until(end) if end < max(ends) else column
        for part, end in zip((read.columns, shifted), ends, strict=True)
        for name, column in part.items()
    }
    begin = min(first_moment(read), first_moment(other) + by)
    text = f"{station.run.name} is on the time line of {robot.run.name}: {alignment.how}."
    happened = [*read.happened, *(each._replace(time=each.time + by / 1e6) for each in other.happened)]
    happened.append(Happened(begin / 1e6, "info", text))
    problem = "; ".join(f"{each.run.name}: {each.problem}" for each in (robot, station) if each.problem)
    joined = ReadLog(columns, {**read.types, **other.types}, happened, problem, read.when, begin)
    run = run_of(joined, f"{robot.run.name} and {station.run.name}", height)
    return replace(robot, run=run, when=when_of(joined) or robot.when, problem=problem, read=joined)


def _end(columns: Mapping[str, Column]) -> int:
    return max((column.moments[-1] for column in columns.values() if column.moments), default=0)
