"""Reads a source, such as a simulation, by cursors, on a thread of its own, and keeps what every page shows."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...engine.changes import Change, RunBegan
from ...engine.messages import MODE
from ...logs.align import modes_of
from ..models.devices import DeviceRows, Panel
from ..models.wording import clock
from .console import Console
from .marks import Marks
from .runs import Branch, Runs

if TYPE_CHECKING:
    from ...engine.scene import Field
    from ...engine.snapshot import Failure, Snapshot, Status
    from ...engine.source import Source

#: How often to look when nothing is reported, and the shortest interval of looks, in wall seconds.
_LONGEST, _SHORTEST = 0.1, 0.008
#: The most changes that are read in one look, so that the page does not wait for all of a long replay.
_MOST_CHANGES = 1024
_BUTTONS = tuple(f"joysticks[{number}].buttons" for number in range(6))


@dataclass(frozen=True)
class State:
    """What there is to show at one moment.

    :param wants_to_run: whether robot time is to go on
    :param run: the number of the present run, and the moment where it went on
    :param known_from: the moment from which on values are known; 0 until the oldest are forgotten
    """

    snapshot: Snapshot | None
    status: Status
    field: Field
    panels: tuple[Panel, ...]
    branches: tuple[Branch, ...]
    wants_to_run: bool
    run: tuple[int, float]
    known_from: float


def _moment_of(state: State) -> float:
    """Return the robot time that the robot has come to, also in a replay."""
    if state.status.state == "starting":
        return state.status.replayed
    return 0.0 if state.snapshot is None else state.snapshot.time


class Collector:
    """Follows one source.

    :param changed: called after each look that found something, on the collector's thread
    """

    def __init__(self, source: Source, changed: Callable[[], object]) -> None:
        self._source, self._changed = source, changed
        self.runs, self.marks = Runs(source.recorded), Marks()
        self.console = Console(source.project.root)
        self._output = source.output_cursor()
        self._hal, self._network = source.change_cursor(), source.network_cursor()
        self._project = source.project
        self._rows = DeviceRows(source.project.sim_config)
        #: Whether the last look has left changes for the next one.
        self._has_more = False
        self._run = (0, 0.0)
        self._overruns = self._starts = 0
        self._failure: Failure | None = None
        self._note = ""
        self._announced: list[str] = []
        #: The numbers of lines and marks at the last look.
        self._shown = (0, 0)
        #: The number of the source's branches that are known.
        self._branches = 0
        self._over = threading.Event()
        #: A mistake of pyfrc's own, after which the page would stand still without a word.
        self.mistake: Exception | None = None
        self._thread = threading.Thread(target=self._run_thread, name="pyfrc sim: web collector", daemon=True)
        self._add_recorded()
        self.state = self._state_of(source.snapshot, source.status)

    @property
    def root(self) -> Path:
        """The project's directory."""
        return self._source.project.root

    @property
    def robot(self) -> str | None:
        """The host of the robot elsewhere that is shown; None where there is none."""
        if self._source.abilities.kind != "robot":
            return None
        return (self._source.status.network_address or "").rpartition(":")[0]

    def start(self) -> None:
        """Begin to follow it."""
        self._thread.start()

    def close(self) -> None:
        """End. The state stays."""
        self._over.set()
        if self._thread.is_alive():
            self._thread.join()

    def announce(self, text: str) -> None:
        """Show an event among the robot's output. May be called from any thread."""
        self._announced.append(text)

    def _run_thread(self) -> None:
        try:
            self._follow()
        except Exception as mistake:
            self.mistake = mistake

    def _follow(self) -> None:
        reports = self._source.reports
        while not self._over.is_set():
            began, seen = time.monotonic(), reports.count
            if self.look():
                self._changed()
            if not self._has_more:
                reports.wait_after(seen, _LONGEST)
            if (rest := began + _SHORTEST - time.monotonic()) > 0:
                self._over.wait(rest)

    def look(self) -> bool:
        """Read what is new, and return whether there is anything."""
        before, shown = self.state, self._shown
        source = self._source
        for branch in source.branches[self._branches :]:
            self._branches += 1
            self.runs.add_branch(branch)
        # Before the changes are read, so that they are at least as new as what is shown beside them.
        snapshot, status = source.snapshot, source.status
        now = _moment_of(before)
        for output, printed_at in self._output.read_timed():
            for line in self.console.add(output, now if printed_at is None else printed_at):
                if line.level in ("error", "warning"):
                    self.marks.add(line.t, line.level, line.text.strip())
        changes = self._read_changes()
        self.state = state = self._state_of(snapshot, status)
        self._note_events(state, now)
        self._shown = self.console.count, self.marks.count
        return changes or state != before or self._shown != shown

    def _read_changes(self) -> bool:
        """Read the changes until now, and return whether there are any."""
        hal, network = self._hal.read(_MOST_CHANGES), self._network.read(_MOST_CHANGES)
        self.runs.take("hal", hal, self._look_at_hal)
        self.runs.take("network", network, self._look_at_network)
        self._has_more = len(hal) == _MOST_CHANGES or len(network) == _MOST_CHANGES
        return bool(hal or network)

    def _state_of(self, snapshot: Snapshot | None, status: Status) -> State:
        source = self._source
        project = source.project
        if project is not self._project:
            self._project, self._rows = project, DeviceRows(project.sim_config)
        if snapshot is not None:
            self._rows.update(snapshot.values)
        return State(
            snapshot=snapshot,
            status=status,
            field=source.field,
            panels=self._rows.panels,
            branches=self.runs.branches,
            wants_to_run=source.wants_to_run,
            run=self._run,
            known_from=self.runs.known_from,
        )

    def _add_recorded(self) -> None:
        """Add what has happened in a run that is over."""
        recorded = self._source.recorded
        if recorded is None:
            return
        for at, level, text, is_mark in recorded.happened:
            lines = self.console.say(text, at, level) if level else self.console.add(f"{text}\n", at)
            for line in lines if is_mark else ():
                if line.level in ("error", "warning"):
                    self.marks.add(at, line.level, line.text.strip())
        for at, mode in modes_of(recorded.histories["network"]):
            self.marks.add(at, "mode", mode)

    # -- events ---------------------------------------------------------------------------------------------------

    def _look_at_hal(self, event: RunBegan | Change) -> None:
        if isinstance(event, RunBegan):
            if event.number > 1:  # what the first one has printed may have been read before
                self.marks.forget_after(event.time, except_own=event.new_code)
            if event.number > 1 and not event.new_code:
                what = f"went on from {clock(event.time)}" if event.time else "restarted"
                self.marks.add(event.time, "run", what)
            self._run = event.number, event.time
        for path in _BUTTONS:
            if path in event.values:
                self.marks.look_at_buttons(event.time, path, event.values[path])

    def _look_at_network(self, event: RunBegan | Change) -> None:
        if isinstance(event, Change) and MODE in event.values:
            self.marks.add(event.time, "mode", str(event.values[MODE]))

    def _note_events(self, state: State, now: float) -> None:
        status = state.status
        if status.starts != self._starts:
            self._starts, self._overruns = status.starts, 0
            if status.starts > 1:
                self.console.say("the robot program starts again", now)
        if status.overruns > self._overruns:
            self.marks.add(now, "overrun", f"{status.overruns - self._overruns} loop overruns")
        self._overruns = status.overruns
        if status.failure is not None and status.failure != self._failure:
            self.marks.add(status.failure.time, "failure", status.failure.headline)
            self.console.say(status.failure.details, status.failure.time, "error")
            self.console.say(f"failed: {status.failure.headline}", status.failure.time, "error")
        self._failure = status.failure
        if status.note not in ("", self._note):
            self.console.say(status.note, now)
        self._note = status.note
        while self._announced:
            self.console.say(self._announced.pop(0), now)
