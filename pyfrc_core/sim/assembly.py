"""Snapshots, put together from what the robot's process tells of changes."""

from __future__ import annotations

import json
from types import MappingProxyType
from typing import Any

from .messages import Update
from .scene import Field, Point, Scene
from .snapshot import Snapshot


class Assembly:
    """The snapshots of one run."""

    def __init__(self) -> None:
        self._last: Snapshot | None = None
        self._trail: list[Point] = []

    @property
    def trail(self) -> tuple[Point, ...]:
        """Where the robot has been."""
        return tuple(self._trail)

    def snapshot_after(self, update: Update, field: Field) -> Snapshot:
        """The robot as it is after an update."""
        before = self._last or Snapshot(0.0, "disabled", Scene(field))
        values = _values(before, update)
        self._trail += update.trail
        since = update.station.practice_since_us
        self._last = Snapshot(
            time=update.time_us / 1_000_000,
            mode=update.mode,
            values=MappingProxyType(values),
            choosers=before.choosers if update.choosers is None else update.choosers,
            emergency_stopped=bool(values.get("control.eStop")),
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
        return {path: _frozen(value) for path, value in update.base.items()}
    values = dict(before.values)
    for line in update.lines:
        change = json.loads(line)
        values.update((path, _frozen(value)) for path, value in change["set"].items())
        for path in change.get("gone", ()):
            values.pop(path, None)
    return values


def _frozen(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return tuple(_frozen(each) for each in value)
    if isinstance(value, dict):
        return MappingProxyType({key: _frozen(each) for key, each in value.items()})
    return value
