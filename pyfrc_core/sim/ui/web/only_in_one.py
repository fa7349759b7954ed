"""The topics of NetworkTables that only one of two runs has, and when they came.

They are compared as topics: a list of structs that is still empty has no parts, and what a robot no longer publishes
(a Sendable has one name at a time) stays in a log.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

from ...engine.messages import TYPE, VALUE
from ...engine.past_run import Comparison
from ...engine.value_history import MISSING, ValueHistory
from .differences import is_published
from .plots import same

#: How long after the beginning a value counts as there from the start, in seconds: robotInit and the first loops.
_START = 0.1


class OnlyThere(NamedTuple):
    """A topic that one run has, and the other one does not.

    :param path: of the topic, as of a value
    :param time: when its value came, in seconds; if it was there from the start, when it first changed; None:
        it never did
    :param changes: how often it has changed
    """

    path: str
    time: float | None
    changes: int

    @property
    def order(self) -> tuple[object, ...]:
        """What puts those first that change rarely, such as a command that has run, and those last that never do."""
        return self.time is None, self.changes, self.time or 0.0, self.path


class OnlyInOne(NamedTuple):
    """The topics that only one of two runs has, in the order of `OnlyThere.order`.

    :param both: how many both have
    """

    there: list[OnlyThere]
    here: list[OnlyThere]
    both: int


def topics(history: ValueHistory) -> set[str]:
    """Return the paths of all topics that a run has had."""
    return {VALUE + path.removeprefix(TYPE) for path in history.paths() if path.startswith(TYPE)}


def only_in_one(here: ValueHistory, there: ValueHistory, begin: float, offset: float, by: Comparison) -> OnlyInOne:
    """Return the topics that only `there` has, and those that only `here` has.

    What came in `there` after the end of `here` is left out: it may still have come here.

    :param begin: where both runs begin, in seconds of the one that is here
    :param offset: what is added to the times of the other one
    """
    ours, theirs = topics(here), topics(there)
    shown = {path for path in ours | theirs if is_published(path) and not by.ignores(path)}
    found = _only_in(there, shown & theirs - ours, begin - offset, here.end - offset)
    found = [each if each.time is None else each._replace(time=each.time + offset) for each in found]
    return OnlyInOne(found, _only_in(here, shown & ours - theirs, begin, here.end), len(shown & ours & theirs))


def _only_in(history: ValueHistory, found: Collection[str], begin: float, end: float) -> list[OnlyThere]:
    start = max(begin, 0.0) + _START
    parts: dict[str, list[str]] = {path: [] for path in found}
    for path in history.paths():
        topic = path
        while topic not in parts and "/" in topic:
            topic = topic.rpartition("/")[0]
        if topic in parts:
            parts[topic].append(path)
    made = []
    for topic, paths in parts.items():
        firsts = [time for path in paths if (time := _first_change(history, path, start)) is not None]
        first = min(firsts, default=None)
        if first is None or first <= end or any(history.value_at(path, end) is not MISSING for path in paths):
            made.append(OnlyThere(topic, first, sum(map(history.change_count, paths))))
    return sorted(made, key=lambda each: each.order)


def _first_change(history: ValueHistory, path: str, start: float) -> float | None:
    before = history.value_at(path, start)
    changes = zip(*history.changes(path, start), strict=True)
    return next((time for time, value in changes if not same(value, before)), None)
