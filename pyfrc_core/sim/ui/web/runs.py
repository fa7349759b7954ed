"""The runs of a session with all their values: the present one, and those that were left by going back in time."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from ...engine.changes import Change, RunBegan
from ...engine.messages import MODE, POSE, TYPE, VALUE
from ..models.wording import clock
from .history import MISSING, ValueHistory, packed
from .plots import MOST_POINTS, FirstDifference, picked, resolve, series

Source = Literal["hal", "network"]

#: About how much memory the values of all runs may take together.
MOST_BYTES = 256 << 20
#: Times that are equal but for rounding.
_ROUNDING = 1e-6
#: The most former runs that are kept.
_MOST_BRANCHES = 12


@dataclass(frozen=True)
class Branch:
    """A former run.

    :param number: the number of the run that replaced it
    :param begin: where the present run left it, in seconds of robot time; `end` is where it ended
    :param histories: its values
    """

    number: int
    name: str
    begin: float
    end: float
    histories: dict[Source, ValueHistory] = field(default_factory=dict)

    def plain(self) -> dict[str, object]:
        """Return it for a page."""
        return {"id": self.number, "name": self.name, "from": self.begin, "to": self.end}


class Runs:
    """May be used from any thread.

    :param most_bytes: about how much memory the values may take
    """

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self._lock = threading.Lock()
        self._most_bytes = most_bytes
        self._histories: dict[Source, ValueHistory] = {"hal": ValueHistory(), "network": ValueHistory()}
        #: The number of the run that each of the histories has.
        self._numbers: dict[Source, int] = {"hal": 0, "network": 0}
        self._packets = 0
        self.branches: tuple[Branch, ...] = ()
        #: The run that was left last.
        self._leaving: Branch | None = None

    # -- what is added --------------------------------------------------------------------------------------------

    def take(
        self, source: Source, events: Iterable[RunBegan | Change], look: Callable[[RunBegan | Change], object]
    ) -> None:
        """Add what a cursor has read.

        :param look: called with each event, after it was added
        """
        for event in events:
            with self._lock:
                if isinstance(event, RunBegan):
                    self._begin(source, event)
                else:
                    self._histories[source].add(event.time, event.values, event.gone)
                    self._packets += 1
                    if self._packets % 512 == 0:
                        self._limit()
            look(event)

    def _begin(self, source: Source, began: RunBegan) -> None:
        former = self._histories[source]
        self._keep(source, former, began)
        if not began.values:  # from the start: its changes have everything
            self._histories[source] = ValueHistory()
        else:
            history = former.until(began.time + _ROUNDING)
            now = history.now
            changed = {path: value for path, value in began.values.items() if now.get(path, MISSING) != value}
            history.add(max(began.time, history.end), changed, [path for path in now if path not in began.values])
            self._histories[source] = history
        self._numbers[source] = began.number

    def _keep(self, source: Source, former: ValueHistory, began: RunBegan) -> None:
        """Keep the values of the run before, when those of both sources are there and the run went on further."""
        leaving = self._leaving
        if leaving is None or leaving.number != began.number:
            leaving = Branch(began.number, "", began.time, 0.0)
        histories = {**leaving.histories, source: former}
        end = max(leaving.end, former.end)
        self._leaving = leaving = replace(leaving, name=_name_of(began, end), end=end, histories=histories)
        if len(histories) == len(self._histories) and leaving.end > leaving.begin + _ROUNDING:
            self.branches = (*self.branches, leaving)[-_MOST_BRANCHES:]

    def _limit(self) -> None:
        """Forget former runs, and then the oldest values, until the others fit into the memory that they may take."""
        while self.size > self._most_bytes:
            if self.branches:
                self.branches, self._leaving = self.branches[1:], None
            elif not max(self._histories.values(), key=lambda history: history.size).forget_oldest():
                break

    @property
    def known_from(self) -> float:
        """The moment from which on all values of the present run are known; 0 until the oldest are forgotten."""
        return max(history.known_from for history in self._histories.values())

    @property
    def size(self) -> int:
        """About how many bytes all values take."""
        kept = [history for branch in self.branches for history in branch.histories.values()]
        return sum(history.size for history in (*self._histories.values(), *kept))

    def name(self, number: int, name: str) -> bool:
        """Name a former run, and return whether there is one with this number."""
        with self._lock:
            found = self._branch(number)
            self.branches = tuple(replace(each, name=name) if each is found else each for each in self.branches)
        return found is not None

    # -- what is asked for ----------------------------------------------------------------------------------------

    def values_at(self, time: float, branch: int | None = None) -> dict[str, Any] | None:
        """Return all values at a moment; None if there is no such branch."""
        with self._lock:
            found: dict[str, Any] = {}
            for source in ("hal", "network"):
                history = self._history(source, branch)
                if history is None:
                    return None
                found |= history.values_at(time + _ROUNDING)
        return found

    def plots(
        self, paths: Iterable[str], begin: float, end: float, points: int, branch: int | None
    ) -> dict[str, Any] | None:
        """Return the curves of some values; None if there is no such branch."""
        found = {}
        for path in paths:
            with self._lock:  # for each path: a collector must not wait for all of them
                history = self._history(source_of(path), branch)
                if history is None:
                    return None
                found[path] = series(history, path, begin, end + _ROUNDING, points)
        return found

    def first_difference(self, number: int, paths: Iterable[str] | None) -> FirstDifference | None:
        """Return where a former run and the present one first differ; None if there is no such branch.

        :param paths: the values to compare; None: all
        """
        with self._lock:
            branch = self._branch(number)
            if branch is None:
                return None
            end = max(history.end for history in self._histories.values())
            compared: list[tuple[ValueHistory, ValueHistory, str]] = []
            found = FirstDifference(branch.begin, min(end, branch.end) + _ROUNDING)
            for source, history in self._histories.items():
                former = branch.histories[source]
                known = history.now.keys() | former.now.keys() if paths is None else paths
                chosen = sorted(path for path in known if source_of(path) == source and not path.startswith(TYPE))
                compared += ((history, former, path) for path in chosen)
        for history, former, path in compared:
            with self._lock:  # for each value: a collector must not wait for all of them
                found.compare(history, former, path)
        return found

    def samples(self, paths: Iterable[str], after: Position) -> tuple[dict[str, list[Any]], Position]:
        """Return every change of some values since a position, as times and values in turn, and the next position."""
        found: dict[str, list[Any]] = {}
        with self._lock:
            positions = self._position()
            for path in paths:
                source = source_of(path)
                history = self._histories[source]
                begin = after.packets[source] if after.numbers == positions.numbers else positions.packets[source]
                whole, index = resolve(history, path)
                flat: list[Any] = []
                for time, value in history.since(begin, whole):
                    if (one := picked(value, index)) is not MISSING:
                        flat += (time, one)
                if flat:
                    found[path] = flat[-2 * MOST_POINTS :]
        return found, positions

    def change_counts(self, paths: Iterable[str]) -> dict[str, int]:
        """Return how often each of some values has changed in the present run."""
        with self._lock:
            return {path: len(self._histories[source_of(path)].changes(path)[0]) for path in paths}

    def packed(self, clean: Callable[[str], str]) -> dict[str, Any]:
        """Return the values of the present run for a page without a server.

        :param clean: changes each text
        """
        with self._lock:
            return {source: packed(history, clean) for source, history in self._histories.items()}

    def position(self) -> Position:
        """Return the present end of the values, for `samples`."""
        with self._lock:
            return self._position()

    def changed_since(self, after: Position | None) -> tuple[dict[str, Any], Position, bool]:
        """Return the values that have changed since a position, the next position, and whether these are all values.

        Those that are gone are `MISSING`. All values are returned for another run, and for no position.
        """
        changed: dict[str, Any] = {}
        with self._lock:
            position = self._position()
            is_all = after is None or after.numbers != position.numbers
            if after == position:
                return changed, position, is_all
            for source, history in self._histories.items():
                changed |= history.changed_since(0 if is_all or after is None else after.packets[source])
        return changed, position, is_all

    def present_values(self, paths: Iterable[str]) -> dict[str, Any]:
        """Return the present values of those of some paths that have one."""
        with self._lock:
            now = {path: self._histories[source_of(path)].now.get(path, MISSING) for path in paths}
        return {path: value for path, value in now.items() if value is not MISSING}

    def _position(self) -> Position:
        packets: dict[Source, int] = {source: history.packets for source, history in self._histories.items()}
        return Position(dict(self._numbers), packets)

    def _history(self, source: Source, branch: int | None) -> ValueHistory | None:
        if branch is None:
            return self._histories[source]
        found = self._branch(branch)
        return None if found is None else found.histories[source]

    def _branch(self, number: int) -> Branch | None:
        return next((each for each in self.branches if each.number == number), None)


def _name_of(began: RunBegan, end: float) -> str:
    """Return the name of the run before another one, until a person names it.

    :param end: where it ended
    """
    if began.new_code:
        return f"before the new code at {clock(end)}"
    return f"before {clock(began.time)}" if began.time else "before the restart"


@dataclass(frozen=True)
class Position:
    """A place among the changes: the numbers of the runs, and of the packets in them."""

    numbers: dict[Source, int]
    packets: dict[Source, int]


def source_of(path: str) -> Source:
    """Return which history has a path."""
    return "network" if path.startswith((VALUE, TYPE, MODE, POSE)) else "hal"
