"""The runs of a session with all their values: the present one, and those that were left by going back in time."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ...engine.changes import Change, RunBegan
from ...engine.messages import MODE, POSE, TYPE, VALUE
from ...engine.past_run import EXACT, Comparison, PastRun, Stream
from ...engine.value_history import MISSING, ValueHistory, packed
from ..models.wording import clock
from .differences import FirstDifference, sensors_by_source
from .only_in_one import OnlyInOne, is_mostly_compared, limits, only_in_one
from .plots import MOST_POINTS, picked, resolve, same, series

#: About how much memory the values of all runs may take together.
MOST_BYTES = 256 << 20
#: Times that are equal but for rounding.
_ROUNDING = 1e-6
#: The most changes around a moment that are named.
_MOST_CHANGES = 100
#: The most changes of one value there that are each named.
_MOST_EACH = 8
#: The most former runs that are kept.
_MOST_FORMER = 12
#: The number of the first branch that is no former run.
_FIRST_OTHER = 1 << 20


@dataclass(frozen=True)
class Branch:
    """A former run, or another one that is shown beside the present one, such as a log.

    :param number: the number of the run that replaced it; of others, it is at least `_FIRST_OTHER`
    :param begin: where the present run left it, in seconds of the present run; `end` is where it ended
    :param histories: its values
    :param offset: what is added to its own times
    :param compared: how it is compared with the present run; None: it is not
    """

    number: int
    name: str
    begin: float
    end: float
    histories: Mapping[Stream, ValueHistory] = field(default_factory=dict)
    offset: float = 0.0
    compared: Comparison | None = EXACT

    @property
    def is_former(self) -> bool:
        """Whether it is a former run, which has its times in common with the present one."""
        return self.number < _FIRST_OTHER

    def plain(self) -> dict[str, object]:
        """Return it for a page."""
        found: dict[str, object] = {"id": self.number, "name": self.name, "from": self.begin, "to": self.end}
        return found if self.is_former else found | {"offset": self.offset, "compared": self.compared is not None}

    def packed(self, clean: Callable[[str], str]) -> dict[str, Any]:
        """Return its values for a page without a server.

        :param clean: changes each text
        """
        return {stream: packed(history, clean) for stream, history in self.histories.items()}


class Runs:
    """May be used from any thread.

    :param recorded: the present run, if it is over
    :param most_bytes: about how much memory the values may take; branches that are no former runs do not count
    """

    def __init__(self, recorded: PastRun | None = None, most_bytes: int = MOST_BYTES) -> None:
        self._lock = threading.Lock()
        self._most_bytes = most_bytes
        self._histories: dict[Stream, ValueHistory] = {"hal": ValueHistory(), "network": ValueHistory()}
        if recorded is not None:
            self._histories |= recorded.histories
        #: The number of the run that each of the histories has.
        self._numbers: dict[Stream, int] = {"hal": 0, "network": 0}
        self._packets = 0
        self.branches: tuple[Branch, ...] = ()
        #: The run that was left last.
        self._leaving: Branch | None = None

    # -- what is added --------------------------------------------------------------------------------------------

    def take(
        self, stream: Stream, events: Iterable[RunBegan | Change], look: Callable[[RunBegan | Change], object]
    ) -> None:
        """Add what a cursor has read.

        :param look: called with each event, after it was added
        """
        for event in events:
            with self._lock:
                if isinstance(event, RunBegan):
                    self._begin(stream, event)
                else:
                    self._histories[stream].add(event.time, event.values, event.gone)
                    self._packets += 1
                    if self._packets % 512 == 0:
                        self._limit()
            look(event)

    def _begin(self, stream: Stream, began: RunBegan) -> None:
        former = self._histories[stream]
        self._keep(stream, former, began)
        if not began.values:  # from the start: its changes have everything
            self._histories[stream] = ValueHistory()
        else:
            history = former.until(began.time + _ROUNDING)
            now = history.now
            changed = {path: value for path, value in began.values.items() if now.get(path, MISSING) != value}
            history.add(max(began.time, history.end), changed, [path for path in now if path not in began.values])
            self._histories[stream] = history
        self._numbers[stream] = began.number

    def _keep(self, stream: Stream, former: ValueHistory, began: RunBegan) -> None:
        """Keep the values of the run before, when those of both sources are there and the run went on further."""
        leaving = self._leaving
        if leaving is None or leaving.number != began.number:
            leaving = Branch(began.number, "", began.time, 0.0)
        histories = {**leaving.histories, stream: former}
        end = max(leaving.end, former.end)
        self._leaving = leaving = replace(leaving, name=_name_of(began, end), end=end, histories=histories)
        if len(histories) == len(self._histories) and leaving.end > leaving.begin + _ROUNDING:
            self.branches = (*self.branches, leaving)
            if len(kept := self._former()) > _MOST_FORMER:
                self._forget(kept[0])

    def _limit(self) -> None:
        """Forget former runs, and then the oldest values, until the others fit into the memory that they may take."""
        while self.size > self._most_bytes:
            if former := self._former():
                self._forget(former[0])
                self._leaving = None
            elif not max(self._histories.values(), key=lambda history: history.size).forget_oldest():
                break

    def _former(self) -> list[Branch]:
        return [branch for branch in self.branches if branch.is_former]

    def _forget(self, branch: Branch) -> None:
        self.branches = tuple(each for each in self.branches if each is not branch)

    @property
    def network(self) -> ValueHistory:
        """The present run's values of NetworkTables, its mode and the robot's place."""
        return self._histories["network"]

    def add_branch(self, run: PastRun) -> int:
        """Show another run beside the present one, and return the number of its branch."""
        with self._lock:
            number = max([_FIRST_OTHER - 1, *(branch.number for branch in self.branches)]) + 1
            offset = run.offset
            end = run.end + offset
            branch = Branch(number, run.name, max(offset, 0.0), end, run.histories, offset, run.compared)
            self.branches = (*self.branches, branch)
        return number

    def move(self, number: int, offset: float) -> bool:
        """Change what is added to the times of a branch that is no former run; return whether there is one."""
        with self._lock:
            found = self._branch(number)
            if found is None or found.is_former:
                return False
            by = offset - found.offset
            moved = replace(found, begin=max(offset, 0.0), end=found.end + by, offset=offset)
            self.branches = tuple(moved if each is found else each for each in self.branches)
        return True

    @property
    def known_from(self) -> float:
        """The moment from which on all values of the present run are known; 0 until the oldest are forgotten."""
        return max(history.known_from for history in self._histories.values())

    @property
    def size(self) -> int:
        """About how many bytes all values take."""
        kept = [history for branch in self._former() for history in branch.histories.values()]
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
            for stream in ("hal", "network"):
                history, offset = self._history(stream, branch)
                if history is None:
                    return None
                found |= history.values_at(time - offset + _ROUNDING)
        return found

    def plots(
        self, paths: Iterable[str], begin: float, end: float, points: int, branch: int | None
    ) -> dict[str, Any] | None:
        """Return the curves of some values; None if there is no such branch."""
        found = {}
        for path in paths:
            with self._lock:  # for each path: a collector must not wait for all of them
                history, offset = self._history(stream_of(path), branch)
                if history is None:
                    return None
                curve = series(history, path, begin - offset, end - offset + _ROUNDING, points)
                found[path] = curve | {"t": [time + offset for time in curve["t"]]} if offset else curve
        return found

    def first_difference(self, number: int, paths: Iterable[str] | None, after: float = 0.0) -> FirstDifference | None:
        """Return where a branch and the present run first differ; None if there is no such branch that is compared.

        :param paths: the values to compare; None: all
        :param after: look only from then on, in seconds of robot time
        """
        with self._lock:
            branch = self._branch(number)
            if branch is None or branch.compared is None:
                return None
            end = max(history.end for history in self._histories.values())
            compared: list[tuple[ValueHistory, ValueHistory, str]] = []
            begin, end = max(branch.begin, after), min(end, branch.end) + _ROUNDING
            found = FirstDifference(begin, end, branch.compared, branch.offset)
            for stream, history in self._histories.items():
                former = branch.histories[stream]
                known = self._known(history, former, branch.compared) if paths is None else paths
                chosen = sorted(path for path in known if stream_of(path) == stream and not path.startswith(TYPE))
                compared += ((history, former, path) for path in chosen)
        for history, former, path in compared:
            with self._lock:  # for each value: a collector must not wait for all of them
                found.compare(history, former, path)
        return found

    def plain_difference(
        self, number: int, paths: Iterable[str] | None = None, clean: Callable[[str], str] = str
    ) -> dict[str, Any] | None:
        """Return the same for a page: of a log, with all values that differ, and what moves the sensors.

        :param clean: changes each text
        """
        found = self.first_difference(number, paths)
        if found is None:
            return None
        only = self.only_in_one(number) if found.by.is_log else None
        if only is None:
            return found.plain(clean)
        said = [clean(sentence) for sentence in limits("the log", found, only)]
        known = {"limits": said, "mostly": is_mostly_compared(found, only), "compared": found.compared}
        return found.plain(clean) | known | {"sensors": self.sensors(number)}

    def sensors(self, number: int) -> dict[str, list[str]]:
        """Return the sensors of the present run, by where their values come from: a log that drives it, or not.

        ``replay``: the subsystems whose inputs the log has, which only the library that wrote it can give to the code.
        """
        with self._lock:
            branch, hal, network = self._branch(number), self._histories["hal"], self._histories["network"]
            compared = EXACT if branch is None or branch.compared is None else branch.compared
            return sensors_by_source(hal, network, compared.given) | {"replay": list(compared.replayed)}

    @staticmethod
    def _known(history: ValueHistory, former: ValueHistory, by: Comparison) -> Iterable[str]:
        """Return the values to compare: of a log, those that both have had."""
        if by.is_log:
            return set(history.paths()).intersection(former.paths())
        return history.now.keys() | former.now.keys()

    def only_in_one(self, number: int) -> OnlyInOne | None:
        """Return what only a branch has, and what only the present run has, with the times in it.

        None if there is no such branch that is compared.
        """
        with self._lock:
            branch = self._branch(number)
            if branch is None or branch.compared is None:
                return None
            return only_in_one(self._histories, branch.histories, branch.begin, branch.offset, branch.compared)

    def samples(self, paths: Iterable[str], after: Position) -> tuple[dict[str, list[Any]], Position]:
        """Return every change of some values since a position, as times and values in turn, and the next position.

        Where a value is gone, it is None.
        """
        found: dict[str, list[Any]] = {}
        with self._lock:
            positions = self._position()
            for path in paths:
                stream = stream_of(path)
                history = self._histories[stream]
                begin = after.packets[stream] if after.numbers == positions.numbers else positions.packets[stream]
                whole, index = resolve(history, path)
                flat: list[Any] = []
                for time, value in history.since(begin, whole):
                    flat += (time, _shown(picked(value, index)))
                if flat:
                    found[path] = flat[-2 * MOST_POINTS :]
        return found, positions

    def changes_around(self, time: float, reach: float) -> list[dict[str, Any]]:
        """Return the changes around a moment, those of values that change rarely first.

        Of a value that changes there more than `_MOST_EACH` times, only the first one, with how many there are.

        :param reach: in seconds before and after the moment
        """
        found = []
        with self._lock:
            histories = list(self._histories.values())
        for history in histories:
            with self._lock:
                paths = [path for path in history.paths() if not path.startswith(TYPE)]
            for path in paths:
                with self._lock:  # for each value: a collector must not wait for all of them
                    before = history.value_at(path, time - reach)
                    changes = []
                    for at, value in zip(*history.changes(path, time - reach, time + reach + _ROUNDING), strict=True):
                        if not same(value, before):
                            changes.append((at, before, value))
                            before = value
                    count = history.change_count(path)
                each = {"path": path, "count": count, "near": len(changes)}
                for at, earlier, value in changes if len(changes) <= _MOST_EACH else changes[:1]:
                    found.append(each | {"t": at, "before": _shown(earlier), "after": _shown(value)})
        found.sort(key=lambda change: (change["count"], change["path"], change["t"]))
        return found[:_MOST_CHANGES]

    def change_counts(self, paths: Iterable[str]) -> dict[str, int]:
        """Return how often each of some values has changed in the present run."""
        with self._lock:
            return {path: len(self._histories[stream_of(path)].changes(path)[0]) for path in paths}

    def packed(self, clean: Callable[[str], str]) -> dict[str, Any]:
        """Return the values of the present run for a page without a server.

        :param clean: changes each text
        """
        with self._lock:
            return {stream: packed(history, clean) for stream, history in self._histories.items()}

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
            for stream, history in self._histories.items():
                changed |= history.changed_since(0 if is_all or after is None else after.packets[stream])
        return changed, position, is_all

    def present_values(self, paths: Iterable[str]) -> dict[str, Any]:
        """Return the present values of those of some paths that have one."""
        with self._lock:
            now = {path: self._histories[stream_of(path)].now.get(path, MISSING) for path in paths}
        return {path: value for path, value in now.items() if value is not MISSING}

    def _position(self) -> Position:
        packets: dict[Stream, int] = {stream: history.packets for stream, history in self._histories.items()}
        return Position(dict(self._numbers), packets)

    def _history(self, stream: Stream, branch: int | None) -> tuple[ValueHistory | None, float]:
        """Return the values of the present run or a branch, and what is added to their times."""
        if branch is None:
            return self._histories[stream], 0.0
        found = self._branch(branch)
        return (None, 0.0) if found is None else (found.histories[stream], found.offset)

    def _branch(self, number: int) -> Branch | None:
        return next((each for each in self.branches if each.number == number), None)


def _shown(value: Any) -> Any:
    return None if value is MISSING else value


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

    numbers: dict[Stream, int]
    packets: dict[Stream, int]


def stream_of(path: str) -> Stream:
    """Return which history has a path."""
    return "network" if path.startswith((VALUE, TYPE, MODE, POSE)) else "hal"
