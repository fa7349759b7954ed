"""What NetworkTables show, packet by packet, for front ends that draw it: their values, and the robot's pose and mode.

The lines have the form of a trace's lines. Their paths are targets of input scripts (``nt:/SmartDashboard/kP``), the
same with ``type:`` for the topics' types, and `MODE` and `POSE`, which `hal_data` does not have. Structs come as their
parts, which have no type of their own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ....runtime.scripts.trace_lines import trace_line
from ....wpi import network, station
from ..messages import MODE, POSE, TYPE, VALUE
from ..scene import Pose
from ..structs import SCHEMA, Structs


class NetworkTrace:
    """The changes of the robot's own tables.

    :param pose: returns the robot's place
    """

    def __init__(self, pose: Callable[[], Pose | None]) -> None:
        self._pose = pose
        self._news = network.listen_for_values(current=True, gone=True)
        self._structs = Structs(lambda kind: network.data_of(SCHEMA + kind).decode("utf-8", "replace"))
        #: The paths of the parts of each topic that has any.
        self._parts: dict[str, tuple[str, ...]] = {}
        #: All values at the last look, by path.
        self.values: dict[str, Any] = {}
        self._lines: list[str] = []

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        changed: dict[str, Any] = {MODE: station.mode_name()}
        if (pose := self._pose()) is not None:
            changed[POSE] = [pose.x, pose.y, pose.angle]
        gone: dict[str, None] = {}
        for update in self._news.read():
            name = update.name
            before = self._parts.pop(name, (VALUE + name,))
            parts = {} if update.value is None else self._parts_of(update)
            for path in before:
                if path not in parts:
                    gone[path] = None
                    changed.pop(path, None)
            for path, value in parts.items():
                gone.pop(path, None)
                changed[path] = value
            if parts:
                changed[TYPE + name] = update.type_name
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

    def _parts_of(self, update: network.Update) -> dict[str, Any]:
        """Return a topic's value; of a struct, the values of its parts, except where a topic has the same name."""
        path, value = VALUE + update.name, update.value
        if not isinstance(value, bytes):
            return {path: value}
        parts = self._structs.parts(path, update.type_name, value)
        if len(parts) > 1 or path not in parts:
            parts = {each: part for each, part in parts.items() if TYPE + each.removeprefix(VALUE) not in self.values}
            self._parts[update.name] = tuple(parts)
        return parts
