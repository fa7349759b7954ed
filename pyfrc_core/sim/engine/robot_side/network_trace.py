"""What NetworkTables show, packet by packet, for front ends that draw it: their values, and the robot's pose and mode.

The lines have the form of a trace's lines. Their paths are those of `TopicValues`, and `MODE` and `POSE`, which
`hal_data` does not have.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ....runtime.scripts.trace_lines import trace_line
from ....wpi import network, station
from ..messages import MODE, POSE
from ..scene import Pose
from ..structs import SCHEMA
from ..topic_values import TopicValues


class NetworkTrace:
    """The changes of the robot's own tables.

    :param pose: returns the robot's place
    """

    def __init__(self, pose: Callable[[], Pose | None]) -> None:
        self._pose = pose
        self._news = network.listen_for_values(current=True, gone=True)
        self._topics = TopicValues()
        self._lines: list[str] = []

    @property
    def values(self) -> dict[str, Any]:
        """All values at the last look, by path."""
        return self._topics.values

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
        return dict(self.values) if is_base else {}, lines
