"""Every change of `hal_data` and of NetworkTables in a session, at each reader's own pace."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any
from weakref import WeakSet

from ...runtime.scripts.trace_lines import Change as Change
from .history import History


class ReportSignal(threading.Condition):
    """A condition that counts its notifications: a thread that was busy during one does not wait for the next one."""

    def __init__(self) -> None:
        super().__init__()
        #: The number of notifications so far.
        self.count = 0

    def notify_all(self) -> None:
        """Wake all threads that wait."""
        self.count += 1
        super().notify_all()

    def wait_after(self, count: int, timeout: float) -> None:
        """Wait until there were more notifications than `count`.

        :param timeout: in wall seconds
        """
        with self:
            self.wait_for(lambda: self.count > count, timeout)


@dataclass(frozen=True)
class RunBegan:
    """Another run of the robot began; what was read of moments after `time` is no longer part of the session's past.

    :param number: as in `Status.starts`
    :param time: robot time where it goes on from, in seconds
    :param values: all values there, as in `Snapshot.values`; they replace those read before
    :param new_code: whether it replays the inputs from the start with changed code
    """

    number: int
    time: float
    values: Mapping[str, Any]
    new_code: bool = False


def frozen(value: object) -> Any:
    """Return the same value, with tuples in place of lists."""
    if isinstance(value, (list, tuple)):
        return tuple(map(frozen, value))
    if isinstance(value, dict):
        return {key: frozen(each) for key, each in value.items()}
    return value


class ChangeCursor:
    """One reader's place among the changes. Use it from one thread at a time."""

    def __init__(self) -> None:
        #: What it has not read yet.
        self.entries: deque[RunBegan | Change] = deque()

    def read(self, most: int | None = None) -> list[RunBegan | Change]:
        """Return what has happened since the last call, in order; empty when there is nothing new.

        :param most: return at most this many entries, and the rest with the next calls
        """
        count = len(self.entries) if most is None else min(most, len(self.entries))
        return [self.entries.popleft() for _ in range(count)]


class ChangeFeed:
    """Passes changes on to readers, each at its own pace. May be used from any thread.

    A reader gets what is added after it was made, for as long as its owner keeps it.
    """

    def __init__(self) -> None:
        self._readers: WeakSet[ChangeCursor] = WeakSet()
        self._lock = threading.Lock()  # a set must not grow while another thread goes through it

    def add(self, entry: RunBegan | Change) -> None:
        """Add what has happened."""
        with self._lock:
            readers = tuple(self._readers)
        for reader in readers:
            reader.entries.append(entry)

    def cursor(self) -> ChangeCursor:
        """Return a reader of its own."""
        reader = ChangeCursor()
        with self._lock:
            self._readers.add(reader)
        return reader


class RecordedFeed(ChangeFeed):
    """The changes of one run after the other, which are recorded: a reader gets those of the present run, too.

    :param changes: what the first run has done
    """

    def __init__(self, changes: History[Change]) -> None:
        super().__init__()
        self.launch(changes)

    def launch(self, changes: History[Change]) -> None:
        """Note that another process of the robot was launched, which may never come up.

        :param changes: what it has done, from its start; the first ones may be known from the run before
        """
        self._changes, self._kept = changes, len(changes)
        self._began: RunBegan | None = None

    def report(
        self, number: int, time_us: int, base: Mapping[str, Any] | None, changes: Collection[Change], is_new_code: bool
    ) -> None:
        """Pass on what the robot's process has reported.

        :param number: that of the run
        :param base: all values, where `changes` do not continue those before
        :param is_new_code: whether it replays its inputs from the start with changed code
        """
        if self._began is None and (base is not None or (is_new_code and changes)):
            # Where changes came before the base, they begin with a change that holds all values.
            at, values = (0.0, {}) if changes else (time_us / 1_000_000, frozen(base))
            self._began = RunBegan(number, at, values, is_new_code)
            self.add(self._began)
        for change in changes:
            self.add(change)

    def cursor(self) -> ChangeCursor:
        """Return a reader of its own."""
        reader = super().cursor()
        past: list[RunBegan | Change] = [change for _, change in self._changes]
        if self._began is not None:
            past.insert(self._kept, self._began)
        reader.entries.extend(past)
        return reader
