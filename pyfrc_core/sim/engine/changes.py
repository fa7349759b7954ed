"""Every change of `hal_data` and of NetworkTables in a session, at each reader's own pace.

The changes themselves are the lines of the recording's trace. A session has one run after the other:
going back in time and new code each begin another. Each run knows the next one, and a reader the run that it is at: so
runs are kept as long as a reader has not finished them, and no longer.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from types import MappingProxyType
from typing import Any

from ...errors import UsageError
from ...runtime.scripts.trace_lines import UNREPEATABLE
from .history import History
from .messages import Update
from .recording import Recording


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


@dataclass(frozen=True)
class Change:
    """What changed in one packet.

    :param time: robot time, in seconds
    :param values: the new values by their paths, as in `Snapshot.values`
    :param gone: the paths that no longer exist
    """

    time: float
    values: Mapping[str, Any]
    gone: tuple[str, ...] = ()


def change_of(line: str) -> Change:
    """Return the change that a line of a trace describes."""
    change = json.loads(line)
    found = change["set"] | change.get(UNREPEATABLE, {})
    return Change(change["t"], frozen(found), tuple(change.get("gone", ())))


def frozen(value: object) -> Any:
    """Return the same value, unchangeable."""
    if isinstance(value, (list, tuple)):
        return tuple(frozen(each) for each in value)
    if isinstance(value, dict):
        return MappingProxyType({key: frozen(each) for key, each in value.items()})
    return value


class RunChanges:
    """One run's place in the session.

    :param lines: the trace until now, which grows; the first lines may be those of the run before
    """

    def __init__(self, number: int, lines: History[str]) -> None:
        self.number, self.lines = number, lines
        #: The number of lines from the run before.
        self.first = len(lines)
        #: None as long as the robot has not come up.
        self.began: RunBegan | None = None
        self.next: RunChanges | None = None

    def begin(self, time: float, values: Mapping[str, object], new_code: bool = False) -> None:
        """Note what the run begins with; only the first call counts."""
        if self.began is None:
            self.began = RunBegan(self.number, time, frozen(values), new_code)


class ChangeCursor:
    """One reader's place among the changes. Use it from one thread at a time.

    :param run: the run to begin with, from the start of its lines
    :param lock: held while lines or runs are added
    """

    def __init__(self, run: RunChanges, lock: threading.Condition) -> None:
        self._run, self._lock = run, lock
        self._line = 0
        self._has_begun = False

    def read(self, most: int | None = None) -> list[RunBegan | Change]:
        """Return what has happened since the last call, in order; empty when there is nothing new.

        :param most: return at most this many entries, and the rest with the next calls
        """
        found: list[RunBegan | Change] = []
        with self._lock:
            for entry in self._entries():
                found.append(entry)
                if len(found) == most:
                    break
        return found

    def _entries(self) -> Iterator[RunBegan | Change]:
        """Yield what comes next; each entry counts as read when it is yielded."""
        while True:
            run = self._run
            yield from self._lines_until(run.first)
            if run.began is not None:
                if not self._has_begun:
                    self._has_begun = True
                    yield run.began
                yield from self._lines_until(len(run.lines))
            if run.next is None:
                return
            self._run, self._line, self._has_begun = run.next, run.next.first, False

    def _lines_until(self, end: int) -> Iterator[Change]:
        if self._line < end:
            for _, line in islice(self._run.lines.since(self._line), end - self._line):
                self._line += 1
                yield change_of(line)


class ChangeStreams:
    """Both streams of changes, which begin their runs together.

    :param recording: the recording of the first run
    :param lock: held while anything is added
    :param network: whether changes of NetworkTables are reported
    """

    def __init__(self, recording: Recording, lock: threading.Condition, network: bool) -> None:
        self._lock = lock
        self._hal = RunChanges(0, recording.lines)
        self._network = RunChanges(0, recording.network_lines) if network else None

    def begin_run(self, number: int, recording: Recording) -> None:
        """Note that another process of the robot was launched."""
        hal = RunChanges(number, recording.lines)
        self._hal.next = hal
        self._hal = hal
        if self._network is not None:
            network = RunChanges(number, recording.network_lines)
            self._network.next = network
            self._network = network

    def begin_anew(self) -> None:
        """Note that the run begins at its start, with other code: its changes have everything."""
        self._hal.begin(0.0, {}, new_code=True)
        if self._network is not None:
            self._network.begin(0.0, {}, new_code=True)

    def begin(self, update: Update) -> None:
        """Note what the run begins with, if this update is its first."""
        if update.base is None:
            return
        now = update.time_us / 1_000_000
        # Where changes came before the base, they begin with a change that holds all values.
        self._hal.begin(*((0.0, {}) if update.lines else (now, update.base)))
        if self._network is not None:
            self._network.begin(*((0.0, {}) if update.network_lines else (now, update.network_base)))

    def cursor(self) -> ChangeCursor:
        """Return a reader of the changes of `hal_data`."""
        return ChangeCursor(self._hal, self._lock)

    def network_cursor(self) -> ChangeCursor:
        """Return a reader of the changes of NetworkTables.

        :raises UsageError: when they are not reported
        """
        if self._network is None:
            raise UsageError("this simulation does not report NetworkTables", remedy="Set SimOptions.network_values.")
        return ChangeCursor(self._network, self._lock)
