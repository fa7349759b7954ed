"""What NetworkTables show, packet by packet, for front ends that draw it: their values, and the robot's pose and mode.

The lines have the form of a trace's lines. Their paths are targets of input scripts (``nt:/SmartDashboard/kP``), the
same with ``type:`` for the topics' types, and `MODE` and `POSE`, which `hal_data` does not have.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ntcore

from ....runtime.scripts.trace_lines import trace_line
from ....wpi import station
from ..messages import MODE, POSE, TYPE, VALUE
from ..scene import Pose
from .structs import StructReader

_VALUES = int(ntcore.EventFlags.kValueAll) | int(ntcore.EventFlags.kImmediate)
_GONE = int(ntcore.EventFlags.kUnpublish)
_RAW = ntcore.NetworkTableType.kRaw


class NetworkTrace:
    """The changes of the robot's own tables.

    :param pose: returns the robot's place
    """

    def __init__(self, pose: Callable[[], Pose | None]) -> None:
        self._pose = pose
        self._news = ntcore.NetworkTableListenerPoller(ntcore.NetworkTableInstance.getDefault())
        self._news.addListener([""], _VALUES | _GONE)
        self._structs = StructReader()
        #: All values at the last look, by path.
        self.values: dict[str, Any] = {}
        self._lines: list[str] = []

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        changed: dict[str, Any] = {MODE: station.mode_name()}
        if (pose := self._pose()) is not None:
            changed[POSE] = [pose.x, pose.y, pose.angle]
        gone: dict[str, None] = {}
        for event in self._news.readQueue():
            data = event.data
            if isinstance(data, ntcore.ValueEventData):
                name, type_name = data.topic.getName(), data.topic.getTypeString()
                gone.pop(VALUE + name, None)
                changed[VALUE + name] = self._plain(name, type_name, data.value)
                changed[TYPE + name] = type_name
            elif isinstance(data, ntcore.TopicInfo):
                gone[VALUE + data.name] = None
                changed.pop(VALUE + data.name, None)
        values = self.values
        changed = {path: value for path, value in changed.items() if path not in values or values[path] != value}
        lost = [path for path in gone if values.pop(path, None) is not None]
        if changed or lost:
            values.update(changed)
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

    def _plain(self, name: str, type_name: str, value: ntcore.Value) -> Any:
        found = value.value()
        if value.type() == _RAW:
            return self._structs.read(name, type_name, bytes(found))
        return list(found) if isinstance(found, (list, tuple)) else found
