"""The messages that bring a page up to date: only what has changed since the last one that it was sent.

Each page has a builder of its own. A page that reads slowly gets fewer and larger updates, and no queue grows.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from ...engine.messages import MODE, POSE, TYPE, VALUE
from ...engine.scene import Field, Line, Point, Text
from ...engine.snapshot import Snapshot, Status
from ...engine.value_history import MISSING
from ..models.devices import SETTABLE, Panel
from ..models.wording import STATIONS, mode_text, station_name
from .collector import Collector, State
from .runs import Position

#: The attributes of `Status` that pages get as they are, and those in seconds, which are rounded.
_AS_IT_IS = ("state", "speed", "late_packets", "overruns", "note", "responding", "starts", "network_address")
_SECONDS = ("packet_seconds", "worst_packet_seconds", "worst_loop_seconds", "length")
#: What a page always has: the robot's place and mode, and what the folders of NetworkTables are.
_ALWAYS, _ALWAYS_ENDING = (MODE, POSE), "/.type"
_PLACE = re.compile(r"(?P<file>[^\s:]+\.py):(?P<line>\d+)")


class UpdateBuilder:
    """What one page has been sent.

    :param image: the address of the field's picture; empty: none
    """

    def __init__(self, collector: Collector, image: str) -> None:
        self._collector, self._image = collector, image
        self._state: State | None = None
        self._parts: dict[str, Any] = {}
        self._status: dict[str, Any] = {}
        self._station: dict[str, Any] = {}
        #: The paths of the values that the page has, and the place among the changes up to which it has them.
        self._paths: set[str] = set()
        self._place: Position | None = None
        self._trail: tuple[Point, ...] = ()
        self._lines = self._marks = 0
        self._run = (0, 0.0)
        #: The values that the page shows: only their changes are sent. None: all.
        self._shown: frozenset[str] | None = None
        self._beginnings: tuple[str, ...] = ()
        #: The values that have changed since they were sent, and whether others of them are shown than before.
        self._stale: set[str] = set()
        self._shows_others = False
        #: Whether there is a later time than the page has, and nothing else that is new.
        self.is_late = False
        #: The paths whose every change is sent, and the place up to which they were.
        self._subscribed: tuple[str, ...] = ()
        self._position: Position | None = None

    def subscribe(self, paths: Iterable[str]) -> None:
        """Send every change of these values from now on; of values that are sent already, without a hole."""
        if not self._subscribed or self._position is None:
            self._position = self._collector.runs.position()
        self._subscribed = tuple(paths)

    def show(self, paths: Iterable[str], beginnings: Iterable[str]) -> None:
        """Send changes only of these values, of those whose paths begin so, and each value when it is new."""
        self._shown, self._beginnings, self._shows_others = frozenset(paths), tuple(beginnings), True

    def is_shown(self, path: str) -> bool:
        """Return whether the page needs a value: it shows it, or does not know it yet."""
        shown = self._shown
        return (
            shown is None
            or path in shown
            or path in _ALWAYS
            or path.endswith(_ALWAYS_ENDING)
            or path.startswith((TYPE, *self._beginnings))
            or path not in self._paths
        )

    def update(self, clients: int, with_time: bool = True) -> dict[str, Any]:
        """Return what has changed, empty when nothing has.

        :param with_time: if only time has passed, return that, too
        """
        state = self._collector.state
        found: dict[str, Any] = {}
        if state.run != self._run:
            self._run, self._marks = state.run, 0
            found["run"] = {"number": state.run[0], "t": state.run[1]}
        self._differences(found, "status", self._status, _status(state.status, state.wants_to_run))
        self._differences(found, "station", self._station, _station(state.snapshot, state.status))
        if (snapshot := state.snapshot) is not None and (self._state is None or self._state.snapshot is not snapshot):
            self._add_snapshot(found, snapshot)
        self._add_values(found)
        before = self._state
        if before is None or state.panels is not before.panels:
            found["panels"] = [_panel(panel) for panel in state.panels]
        if before is None or state.field != before.field:
            found["field"] = _field(state.field, self._image)
        if before is None or state.branches is not before.branches:
            found["branches"] = [branch.plain() for branch in state.branches]
        if before is None or state.status.former_trail is not before.status.former_trail:
            found["former_trail"] = _rounded(state.status.former_trail)
        self._part(found, "clients", clients)
        self._part(found, "known_from", round(state.known_from, 6))
        self._add_lines(found)
        self._add_samples(found)
        self._state = state
        late = state.snapshot is not None and round(state.snapshot.time, 6) != self._parts.get("t")
        self.is_late = late and not (found or with_time)
        if found or with_time:
            self._add_time(found, state)
        return found

    def _add_time(self, found: dict[str, Any], state: State) -> None:
        """Add what changes as long as time goes on, even if nothing else happens."""
        self._differences(found, "status", self._status, _figures(state.status))
        if (snapshot := state.snapshot) is not None:
            self._part(found, "t", round(snapshot.time, 6))
            self._differences(found, "station", self._station, {"match_left": round(snapshot.match_left, 2)})

    def _differences(self, found: dict[str, Any], key: str, before: dict[str, Any], now: dict[str, Any]) -> None:
        changed = {name: value for name, value in now.items() if before.get(name, MISSING) != value}
        if changed:
            before.update(changed)
            found.setdefault(key, {}).update(changed)

    def _part(self, found: dict[str, Any], key: str, value: Any) -> None:
        if self._parts.get(key, MISSING) != value:
            self._parts[key] = value
            found[key] = value

    def _add_snapshot(self, found: dict[str, Any], snapshot: Snapshot) -> None:
        scene = snapshot.scene
        robot = scene.robot
        self._part(found, "robot", None if robot is None else [robot.x, robot.y, robot.angle])
        if scene.trail is not self._trail:
            start, self._trail = len(self._trail) if _continues(self._trail, scene.trail) else 0, scene.trail
            if start < len(scene.trail) or start == 0:
                found["trail"] = {"from": start, "points": _rounded(scene.trail[start:])}
        former = None if self._state is None else self._state.snapshot
        if former is None or scene.drawings is not former.scene.drawings:
            found["drawings"] = [_drawing(each) for each in scene.drawings]
        if former is None or scene.targets is not former.scene.targets:
            found["targets"] = [{"x": each.x, "y": each.y, "in_view": each.in_view} for each in scene.targets]
        if former is None or snapshot.choosers is not former.choosers:
            found["choosers"] = [vars(each) for each in snapshot.choosers]
        if former is None or snapshot.opmodes is not former.opmodes:
            found["opmodes"] = [vars(each) for each in snapshot.opmodes]

    def _add_values(self, found: dict[str, Any]) -> None:
        changed, self._place, is_all = self._collector.runs.changed_since(self._place)
        gone = [path for path, value in changed.items() if value is MISSING and path in self._paths]
        if is_all:
            gone += [path for path in self._paths if path not in changed]
        values = {path: value for path, value in changed.items() if value is not MISSING}
        if is_all:
            self._stale.clear()
        elif self._shown is not None:
            hidden = [path for path in values if not self.is_shown(path)]
            for path in hidden:
                del values[path]
            self._stale.update(hidden)
        if self._shows_others:
            self._shows_others = False
            values |= self._collector.runs.present_values([path for path in self._stale if self.is_shown(path)])
        self._stale.difference_update(values, gone)
        self._paths.update(values)
        self._paths.difference_update(gone)
        parts = {
            "types": {VALUE + path[len(TYPE) :]: value for path, value in values.items() if path.startswith(TYPE)},
            "values": {path: value for path, value in values.items() if not path.startswith(TYPE)},
            "gone": [path for path in gone if not path.startswith(TYPE)],
        }
        found.update({name: part for name, part in parts.items() if part})

    def _add_lines(self, found: dict[str, Any]) -> None:
        console, marks = self._collector.console, self._collector.marks
        if lines := console.since(self._lines):
            found["console"] = [line.plain() for line in lines]
            if dropped := lines[-1].n - self._lines - len(lines):
                found["console_dropped"] = dropped
            self._lines = lines[-1].n
        if new := marks.since(self._marks):
            found["marks"] = [mark.plain() for mark in new]
            self._marks = new[-1].n
        elif "run" in found:
            found["marks"] = []

    def _add_samples(self, found: dict[str, Any]) -> None:
        if self._subscribed and self._position is not None:
            samples, self._position = self._collector.runs.samples(self._subscribed, self._position)
            if samples:
                found["samples"] = samples


def _continues(before: tuple[Point, ...], now: tuple[Point, ...]) -> bool:
    """Return whether a trail has only grown. It has the same points as before, not equal ones."""
    return bool(before) and len(now) >= len(before) and now[0] is before[0] and now[len(before) - 1] is before[-1]


def _rounded(points: Iterable[Point]) -> list[tuple[float, float]]:
    return [(round(x, 3), round(y, 3)) for x, y in points]


def _status(status: Status, wants_to_run: bool) -> dict[str, Any]:
    failure = status.failure
    place = None if failure is None else _PLACE.search(failure.headline)
    return {
        **{name: getattr(status, name) for name in _AS_IT_IS},
        "wants_to_run": wants_to_run,
        "failure": None
        if failure is None
        else {
            "headline": failure.headline,
            "details": failure.details,
            "t": failure.time,
            "file": "" if place is None else place["file"],
            "line": 0 if place is None else int(place["line"]),
        },
    }


def _figures(status: Status) -> dict[str, Any]:
    seconds = {name: round(getattr(status, name), 5) for name in _SECONDS}
    return {**seconds, "reached": round(status.reached, 3), "average": round(status.average, 3)}


def _station(snapshot: Snapshot | None, status: Status) -> dict[str, Any]:
    text, kind = mode_text(snapshot, status)
    found: dict[str, Any] = {"text": text, "kind": kind}
    if snapshot is not None:
        found |= {
            "mode": snapshot.mode,
            "chosen_mode": snapshot.chosen_mode,
            "opmode": snapshot.opmode,
            "enabled": snapshot.enabled,
            "emergency_stopped": snapshot.emergency_stopped,
            "attached": snapshot.station_attached,
            "practice_since": snapshot.practice_since,
            "alliance": STATIONS.get(station_name(snapshot.values.get("alliance_station")), ""),
            "game_message": str(snapshot.values.get("event.game_specific_message") or ""),
        }
    return found


def _panel(panel: Panel) -> dict[str, Any]:
    return {"title": panel.title, "rows": [vars(row) | {"settable": row.kind in SETTABLE} for row in panel.rows]}


def _drawing(drawing: Line | Text) -> dict[str, Any]:
    style = asdict(drawing.style)
    if isinstance(drawing, Line):
        return {"kind": "line", "points": drawing.points, "color": drawing.color, "arrow": drawing.arrow, **style}
    texts = {"text": drawing.text, "x": drawing.x, "y": drawing.y, "color": drawing.color, "size": drawing.size}
    return {"kind": "text", **texts, **style}


def _field(field: Field, image: str) -> dict[str, Any]:
    """Return a field for a page.

    :param image: the address of its picture, if it has one
    """
    return {
        "width": field.width,
        "height": field.height,
        "image": None if field.image is None else f"{image}&v={_stamp(field)}",
        "coordinates": field.coordinates,
        "robot_width": field.robot_width,
        "robot_length": field.robot_length,
        "starts": {name: [pose.x, pose.y, pose.angle] for name, pose in field.starts.items()},
        "objects": [{"color": shape.color, "points": shape.points} for shape in field.objects],
        "parts": [asdict(part) for part in field.parts],
        "tags": [{"number": tag.number, "x": tag.x, "y": tag.y, "angle": tag.angle} for tag in field.tags],
    }


def _stamp(field: Field) -> str:
    """Return a text that changes with the picture."""
    try:
        status = field.image.stat() if field.image is not None else None
    except OSError:
        status = None
    text = f"{field.image} {status and (status.st_mtime_ns, status.st_size)}"
    return hashlib.sha256(text.encode()).hexdigest()[:12]
