"""The topics of NetworkTables, and the devices of `hal_data`, that only one of two runs has, and when they came.

They are compared as topics: a list of structs that is still empty has no parts, and what a robot no longer publishes
(a Sendable has one name at a time) stays in a log. What could not be compared is said before any result: `limits`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import NamedTuple

from ....hal.paths import format_path, parse_path
from ....runtime.scripts.sensors import camera_of
from ....wording import counted
from ...engine.messages import TYPE, VALUE
from ...engine.past_run import Comparison, Stream
from ...engine.value_history import MISSING, ValueHistory
from .differences import FirstDifference, is_compared
from .plots import same

#: How long after the beginning a value counts as there from the start, in seconds: robotInit and the first loops.
_START = 0.1
#: Of fewer values, it is not said that a log is of another robot.
_FEWEST = 10


class OnlyThere(NamedTuple):
    """A topic or a device that one run has, and the other one does not.

    :param path: of the topic, as of a value; of a device, its name
    :param time: when its value came, in seconds; if it was there from the start, when it first changed; None:
        it never did
    :param changes: how often it has changed
    """

    path: str
    time: float | None
    changes: int


def _order(only: OnlyThere) -> tuple[object, ...]:
    """Put those first that change rarely, such as a command that has run, and those last that never do."""
    return only.time is None, only.changes, only.time or 0.0, only.path


class OnlyInOne(NamedTuple):
    """The topics, and the devices that move, that only one of two runs has; and how many both have."""

    there: list[OnlyThere]
    here: list[OnlyThere]
    both: int


def device_of(path: str) -> str:
    """Return the device of a value in `hal_data`, or the camera of one in NetworkTables."""
    if (camera := camera_of(path.removeprefix(VALUE))) is not None:
        return camera
    segments = parse_path(path)
    return str(segments[1]) if segments[0] == "CAN" else format_path(segments[:-1] or segments)


_Histories = Mapping[Stream, ValueHistory]


def only_in_one(here: _Histories, there: _Histories, begin: float, offset: float, by: Comparison) -> OnlyInOne:
    """Return what only `there` has, and what only `here` has.

    What came in `there` after the end of `here` is left out: it may still have come here.

    :param begin: where both runs begin, in seconds of the one that is here
    :param offset: what is added to the times of the other one
    """
    left: list[OnlyThere] = []
    added: list[OnlyThere] = []
    both = 0
    for stream, own in here.items():
        ours, theirs = _parts(own, by), _parts(other := there[stream], by)
        if theirs:  # a trace has no topics, and the log of a real robot has no outputs in hal_data
            left += _only_in(other, theirs, ours.keys(), begin, own.end, offset)
            added += _only_in(own, ours, theirs.keys(), begin, own.end, 0.0)
            both += sum(1 for whole in ours.keys() & theirs.keys() if _counts(other, whole, theirs[whole]))
    return OnlyInOne(sorted(left, key=_order), sorted(added, key=_order), both)


def _parts(history: ValueHistory, by: Comparison) -> dict[str, list[str]]:
    """Return the topics and devices that are compared, each with the paths of its values."""
    topics = (VALUE + path.removeprefix(TYPE) for path in history.paths() if path.startswith(TYPE))
    parts: dict[str, list[str]] = {topic: [] for topic in topics if is_compared(topic, by)}
    for path in history.paths():
        whole = path
        if path.startswith(VALUE):
            while whole not in parts and "/" in whole:
                whole = whole.rpartition("/")[0]
        elif is_compared(path, by):
            parts.setdefault(whole := device_of(path), [])
        if whole in parts:
            parts[whole].append(path)
    return parts


def _counts(history: ValueHistory, whole: str, paths: Iterable[str]) -> bool:
    """Return whether it matters if something is there: a device that never does anything does not."""
    return whole.startswith(VALUE) or any(map(history.moves, paths))


def _only_in(
    history: ValueHistory,
    parts: Mapping[str, list[str]],
    known: Collection[str],
    begin: float,
    end: float,
    offset: float,
) -> Iterator[OnlyThere]:
    start, end = max(begin - offset, 0.0) + _START, end - offset
    for whole, paths in parts.items():
        if whole in known or not _counts(history, whole, paths):
            continue
        firsts = [time for path in paths if (time := _first_change(history, path, start)) is not None]
        first = min(firsts, default=None)
        if first is None or first <= end or any(history.value_at(path, end) is not MISSING for path in paths):
            yield OnlyThere(whole, None if first is None else first + offset, sum(map(history.change_count, paths)))


def _first_change(history: ValueHistory, path: str, start: float) -> float | None:
    before = history.value_at(path, start)
    changes = zip(*history.changes(path, start), strict=True)
    return next((time for time, value in changes if not same(value, before)), None)


# -- what that means --------------------------------------------------------------------------------------------------


def is_mostly_compared(found: FirstDifference, only: OnlyInOne) -> bool:
    """Return whether more was compared of what a log has than not."""
    missing = len(only.there) + len(found.never)
    return not missing or only.both - len(found.never) > missing


def limits(name: str, found: FirstDifference, only: OnlyInOne) -> Iterator[str]:
    """Yield what could not be compared with a log, as sentences without a full stop: what comes before any result.

    :param name: that of the log
    """
    yield from (sentence for _, sentence in found.by.limits)
    if not is_mostly_compared(found, only) and found.compared:
        missing, total = len(only.there) + len(found.never), len(only.there) + only.both
        are = "is" if missing == 1 else "are"
        whose = ", so it seems to be of another robot" if total >= _FEWEST else ""
        yield f"little can be compared: {missing} of the {counted(total, 'value')} of {name} {are} not set here{whose}"
