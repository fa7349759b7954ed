"""Builds snapshots from the changes that the robot's process reports."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from .changes import frozen
from .messages import Update
from .scene import Field, Point, Scene
from .snapshot import Snapshot, Status

#: The number of the trail's last points that are all shown, and the most points that are shown before them.
_RECENT_POINTS, _OLDER_POINTS = 2048, 4096


class _Trail:
    """The robot's path; of a long path, fewer and fewer of the older points."""

    def __init__(self) -> None:
        self._older: list[Point] = []
        self._recent: list[Point] = []
        #: One of this many points is kept among the older ones; and the number of all older points.
        self._every, self._count = 1, 0
        self.points: tuple[Point, ...] = ()

    def add(self, points: Iterable[Point]) -> None:
        self._recent += points
        excess = len(self._recent) - _RECENT_POINTS
        if excess > _RECENT_POINTS // 2:  # rarely, since front ends then draw the whole trail again
            for point in self._recent[:excess]:
                if self._count % self._every == 0:
                    self._older.append(point)
                self._count += 1
            del self._recent[:excess]
            while len(self._older) > _OLDER_POINTS:
                del self._older[1::2]
                self._every *= 2
        self.points = (*self._older, *self._recent)


class SnapshotBuilder:
    """Builds the snapshots of one run."""

    def __init__(self) -> None:
        self._last: Snapshot | None = None
        self._trail = _Trail()

    @property
    def trail(self) -> tuple[Point, ...]:
        """The robot's path."""
        return self._trail.points

    def snapshot_after(self, update: Update, field: Field) -> Snapshot:
        """Return the snapshot after an update."""
        before = self._last or Snapshot(0.0, "disabled", Scene(field))
        values = _values(before, update)
        if update.trail:
            self._trail.add(update.trail)
        since = update.station.practice_since_us
        self._last = Snapshot(
            time=update.time_us / 1_000_000,
            mode=update.mode,
            values=MappingProxyType(values),
            choosers=before.choosers if update.choosers is None else update.choosers,
            opmodes=before.opmodes if update.opmodes is None else update.opmodes,
            emergency_stopped=bool(values.get("control.eStop")),
            station_attached=bool(values.get("control.dsAttached", True)),
            practice_since=None if since is None else since / 1_000_000,
            match_left=values.get("time.remaining", 0.0),
            distance=update.distance,
            mode_seconds=MappingProxyType(dict(update.mode_seconds)),
            scene=Scene(
                field=field,
                robot=update.robot,
                trail=self.trail,
                drawings=before.scene.drawings if update.drawings is None else update.drawings,
                targets=before.scene.targets if update.targets is None else update.targets,
            ),
        )
        return self._last


def _values(before: Snapshot, update: Update) -> dict[str, Any]:
    if update.base is not None:
        return dict(frozen(update.base))
    values = before.values.copy()
    for change in update.changes:
        values.update(change.values)
        for path in change.gone:
            values.pop(path, None)
    return values


def status_at_start(status: Status, forward_to_us: int) -> Status:
    """Return the status when another process of the robot is launched.

    :param forward_to_us: the moment that it replays to
    """
    forward_to = forward_to_us / 1_000_000
    starts = status.starts + 1
    return replace(
        status, state="starting", failure=None, note="", starts=starts, replayed=0.0, replaying_to=forward_to
    )


def status_after(status: Status, update: Update, length_us: int) -> Status:
    """Return the status after an update.

    :param length_us: the end of the recording
    """
    return replace(
        status,
        state="paused" if update.time_state.paused else "running",
        speed=update.time_state.speed,
        reached=update.reached,
        average=update.average,
        packet_seconds=update.packet_seconds,
        worst_packet_seconds=update.worst_packet_seconds,
        late_packets=update.late_packets,
        overruns=update.overruns,
        worst_loop_seconds=update.worst_loop_seconds,
        length=length_us / 1_000_000,
        note="\n".join(update.notes) or status.note,
    )
