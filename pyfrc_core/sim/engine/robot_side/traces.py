"""What the robot does, packet by packet, until it is reported: the changes of `hal_data` and of NetworkTables.

NetworkTables are for front ends that draw them. The paths of their values are those of `TopicValues`, and `MODE` and
`POSE`, which `hal_data` does not have.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ....runtime.scripts.trace import TracedChanges
from ....runtime.scripts.trace_lines import Change
from ....wpi import network, station
from ..changes import frozen
from ..messages import MODE, POSE
from ..scene import Pose
from ..structs import SCHEMA
from ..topic_values import TopicValues

if TYPE_CHECKING:
    from ....hal import HalData


class NetworkTrace:
    """The changes of the robot's own tables.

    :param pose: returns the robot's place
    """

    def __init__(self, pose: Callable[[], Pose | None]) -> None:
        self._pose = pose
        self._news = network.listen_for_values(current=True, gone=True)
        self.topics = TopicValues()
        self._changes: list[Change] = []

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        self.topics.note(MODE, station.mode_name())
        if (pose := self._pose()) is not None:
            self.topics.note(POSE, [pose.x, pose.y, pose.angle])
        for update in sorted(self._news.read(), key=lambda each: SCHEMA not in each.name):
            self.topics.take(update.name, "" if update.value is None else update.type_name, update.value)
        changed, lost = self.topics.changes()
        if changed or lost:
            self._changes.append(Change(round(now, 6), frozen(changed), tuple(lost)))

    def take(self) -> tuple[Change, ...]:
        """Return what was found since the last call."""
        changes, self._changes = self._changes, []
        return tuple(changes)


class Traces:
    """Both traces.

    :param network: None: NetworkTables are not reported
    """

    def __init__(self, hal_data: HalData, network: NetworkTrace | None) -> None:
        self._hal, self._network = TracedChanges(hal_data), network
        #: False in a replay that does the same as the run before: its changes are known.
        self.is_on = False

    def look(self, now: float) -> None:
        """Note what has changed by `now`, in seconds of robot time."""
        self.look_at_hal(now)
        if self._network is not None:
            self._network.look(now)

    def look_at_hal(self, now: float) -> None:
        """Note what has changed of `hal_data`."""
        self._hal.look(now)

    def skip(self, now: float) -> None:
        """Take over what NetworkTables show, where it is known."""
        if self._network is not None and not self.is_on:
            self._network.look(now)
            self._network.take()

    def skip_hal(self, now: float) -> None:
        """Take over what `hal_data` shows, where it is known: only what changes from now on is noted."""
        if not self.is_on:
            self._hal.look(now)
            self._hal.take()

    def take(self, now: float) -> tuple[tuple[Change, ...], tuple[Change, ...]]:
        """Return the new changes: those of `hal_data`, and those of NetworkTables until `now`."""
        network: tuple[Change, ...] = ()
        if self._network is not None:
            self._network.look(now)
            network = self._network.take()
        hal = tuple(replace(change, values=frozen(change.values)) for change in self._hal.take())
        return hal, network if self.is_on else ()

    @property
    def network_values(self) -> dict[str, Any]:
        """All values of NetworkTables at the last look."""
        return {} if self._network is None else dict(self._network.topics.values)
