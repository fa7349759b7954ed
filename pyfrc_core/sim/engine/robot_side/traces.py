"""What the robot does, packet by packet, until it is reported: the lines of `hal_data` and of NetworkTables.

NetworkTables are for front ends that draw them. The paths of their lines are those of `TopicValues`, and `MODE` and
`POSE`, which `hal_data` does not have.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ....runtime.scripts.trace import Trace
from ....runtime.scripts.trace_lines import trace_line
from ....wpi import network, station
from ..messages import MODE, POSE
from ..scene import Pose
from ..structs import SCHEMA
from ..topic_values import TopicValues


class _Lines(list[str]):
    """A file for a trace's lines."""

    def write(self, lines: str) -> None:
        self += [f"{line}\n" for line in lines.split("\n")[:-1]]


class NetworkTrace:
    """The changes of the robot's own tables.

    :param pose: returns the robot's place
    """

    def __init__(self, pose: Callable[[], Pose | None]) -> None:
        self._pose = pose
        self._news = network.listen_for_values(current=True, gone=True)
        self._topics = TopicValues()
        self._lines: list[str] = []

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        self._topics.note(MODE, station.mode_name())
        if (pose := self._pose()) is not None:
            self._topics.note(POSE, [pose.x, pose.y, pose.angle])
        for update in sorted(self._news.read(), key=lambda each: SCHEMA not in each.name):
            self._topics.take(update.name, "" if update.value is None else update.type_name, update.value)
        changed, lost = self._topics.changes()
        if changed or lost:
            self._lines.append(trace_line(round(now, 6), changed, lost) + "\n")

    def skip(self, now: float) -> None:
        """Take over what has changed by `now` without a line: it is known from the run before."""
        self.look(now)
        self._lines.clear()

    def report(self, now: float, is_base: bool, is_known: bool) -> tuple[dict[str, Any], tuple[str, ...]]:
        """Return all values, where the report is a base, and the lines since the last report.

        :param is_known: whether the changes are those of a replay, which need no lines
        """
        self.look(now)
        lines = () if is_known else tuple(self._lines)
        self._lines.clear()
        return dict(self._topics.values) if is_base else {}, lines


class Traces:
    """Both traces.

    :param network: None: NetworkTables are not reported
    """

    def __init__(self, hal_data: Any, network: NetworkTrace | None) -> None:
        self._lines = _Lines()
        self._trace = Trace(hal_data, self._lines)  # type: ignore[arg-type]
        self._lines.clear()  # its header
        self._network = network
        #: False in a replay that does the same as the run before: its lines are known.
        self.is_on = False

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        self.look_at_hal(now)
        if self._network is not None:
            self._network.look(now)

    def look_at_hal(self, now: float) -> None:
        """Note what has changed of `hal_data`."""
        self._trace.look(now)

    def skip(self, now: float) -> None:
        """Take over what NetworkTables show, where it is known."""
        if self._network is not None and not self.is_on:
            self._network.skip(now)

    def skip_hal(self, now: float) -> None:
        """Take over what `hal_data` shows, where it is known: only what changes from now on is noted."""
        if not self.is_on:
            self._trace.look(now)
            self._trace.write_lines()
            self._lines.clear()

    def take(self) -> tuple[str, ...]:
        """Return the new lines of `hal_data`."""
        self._trace.write_lines()
        lines = tuple(self._lines)
        self._lines.clear()
        return lines

    def take_network(self, now: float, is_base: bool = False) -> tuple[dict[str, Any], tuple[str, ...]]:
        """Return all values of NetworkTables, where the report is a base, and the new lines."""
        return ({}, ()) if self._network is None else self._network.report(now, is_base, not self.is_on)
