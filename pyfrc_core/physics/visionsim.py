"""Simulate a camera that detects targets: what it sees, and when the robot receives the data.

Positions are in feet, x to the right and y down, as returned by `physics_controller.get_position`; angles are
clockwise, from 0 = east.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Sequence
from typing import Protocol

from .parameters import ParameterError, finite, not_negative, positive

#: One target in one frame: (1, capture time in s, degrees clockwise from the camera's axis, feet); for a frame without
#: targets (0, capture time, inf, 0).
Sighting = tuple[int, float, float, float]

# Robot time is counted in microseconds: an event within this many seconds is due.
_TICK = 1e-6


class VisionSimTarget:
    """A target on the field that a camera can see from one side.

    If it can be seen from 90 to 270 degrees, the robot must be to the west of it, from south through west to north.
    """

    def __init__(self, x: float, y: float, view_angle_start: float, view_angle_end: float) -> None:
        """
        :param x: position on the field, in feet
        :param y: position on the field, in feet, increasing downwards
        :param view_angle_start: start of the directions from the target to the robot in which it is visible: degrees, 0
            = east, clockwise
        :param view_angle_end: end of these directions, clockwise from the start; 0 to 360 is all around
        :raises ParameterError: when a value is not a number
        """
        self.x = finite(x, "x")
        self.y = finite(y, "y")
        self.view_angle_start = finite(view_angle_start, "view_angle_start")
        self.view_angle_end = finite(view_angle_end, "view_angle_end")

    def __repr__(self) -> str:
        return f"VisionSimTarget({self.x}, {self.y}, {self.view_angle_start}, {self.view_angle_end})"

    def compute(self, now: float, x: float, y: float, angle: float) -> Sighting | None:
        """Return what a camera with unlimited view on the robot sees of this target.

        `VisionSim` calls this for each of its targets: a subclass may move a target, or hide it.

        :param now: robot time, in seconds
        :param x: the robot's position, in feet
        :param y: the robot's position, in feet, increasing downwards
        :param angle: the robot's angle, in radians, clockwise from east
        :returns: (1, `now`, offset in degrees, distance in feet), with offsets to the right positive; None where the
            target cannot be seen
        """
        if not self.faces(x, y):
            return None
        dx, dy = self.x - x, self.y - y
        offset = math.degrees(math.remainder(math.atan2(dy, dx) - angle, math.tau))
        return 1, now, offset, math.hypot(dx, dy)

    def faces(self, x: float, y: float) -> bool:
        """Return whether the target can be seen from (x, y), at any distance."""
        span = self.view_angle_end - self.view_angle_start
        span = 360 if abs(span) >= 360 else span % 360
        bearing = math.degrees(math.atan2(y - self.y, x - self.x))
        return (bearing - self.view_angle_start) % 360 <= span


class DrawsVisionTargets(Protocol):
    """The part of a physics controller that `VisionSim` uses."""

    def draw_vision_targets(self, targets: Sequence[VisionSimTarget], seen: Sequence[VisionSimTarget], /) -> None:
        """Show the targets, and which of them are in view."""


class VisionSim:
    """A camera in the robot's centre, looking forward, with its image processing.

    It takes frames at a constant frequency, starting with the first call of :meth:`compute`. Each frame shows what is
    in view at the first call after it is due. Its data are returned by the first call after `data_lag` has passed. If
    several frames have arrived by then, the newest is returned, as from a table with the latest value.
    """

    Target = VisionSimTarget

    def __init__(
        self,
        targets: Iterable[VisionSimTarget],
        camera_fov: float,
        view_dst_start: float,
        view_dst_end: float,
        data_frequency: float = 15,
        data_lag: float = 0.05,
        physics_controller: DrawsVisionTargets | None = None,
    ) -> None:
        """
        :param targets: the targets
        :param camera_fov: the camera's field of view, in degrees, half of it on each side
        :param view_dst_start: the shortest distance at which targets are visible, in feet
        :param view_dst_end: the longest distance at which targets are visible, in feet
        :param data_frequency: frames per second
        :param data_lag: seconds between the capture of a frame and its arrival at the robot
        :param physics_controller: if given, shows the targets on the field
        :raises ParameterError: for impossible values
        """
        self._targets = tuple(targets)
        for target in self._targets:
            if not isinstance(target, VisionSimTarget):
                raise ParameterError(
                    f"targets: {target!r} is not a target", remedy="make each with VisionSim.Target(...)"
                )
        self._half_fov = positive(camera_fov, "camera_fov") / 2
        self._nearest = not_negative(view_dst_start, "view_dst_start")
        self._farthest = finite(view_dst_end, "view_dst_end")
        if self._farthest < self._nearest:
            raise ParameterError(f"view_dst_end = {view_dst_end!r} is below view_dst_start = {view_dst_start!r}")
        self._period = 1 / positive(data_frequency, "data_frequency")
        self._lag = not_negative(data_lag, "data_lag")
        self._controller = physics_controller

        self._first_frame: float | None = None
        self._next_frame = 0
        self._in_flight: deque[list[Sighting]] = deque()
        self._immediate_distance: float | None = None
        self._seen: tuple[VisionSimTarget, ...] | None = None
        self._show(())

    def compute(self, now: float, x: float, y: float, angle: float) -> list[Sighting] | None:
        """Call this in each `update_sim` while vision processing is enabled.

        :param now: robot time, in seconds
        :param x: the robot's position, in feet
        :param y: the robot's position, in feet, increasing downwards
        :param angle: the robot's angle, in radians, clockwise from east
        :returns: None when no frame has arrived; else the frame: (1, capture time, offset in degrees, distance in feet)
            for each target in view, with offsets to the right positive, the smallest offset first; for a frame without
            targets a list of one (0, capture time, inf, 0)
        :raises ParameterError: for a position that is not finite
        """
        if not math.isfinite(x + y + angle):
            raise ParameterError(f"x, y, angle = {x!r}, {y!r}, {angle!r}: must be finite numbers")
        in_view = self._in_view(now, x, y, angle)
        self._show(tuple(target for _, target in in_view))
        in_view.sort(key=lambda sight: abs(sight[0][2]))
        self._immediate_distance = in_view[0][0][3] if in_view else None
        if self._first_frame is not None and now < self._first_frame:
            self.dont_compute()  # a new run has started
        if self._frame_is_due(now):
            frame = [sighting for sighting, _ in in_view]
            self._in_flight.append(frame or [(0, now, math.inf, 0)])
        arrived = None
        while self._in_flight and self._in_flight[0][0][1] + self._lag <= now + _TICK:
            arrived = self._in_flight.popleft()
        return arrived

    def dont_compute(self) -> None:
        """Call this instead while vision processing is disabled: frames that have not arrived are lost."""
        self._in_flight.clear()
        self._first_frame = None
        self._show(())

    def get_immediate_distance(self) -> float | None:
        """Return the distance of the most central target at the last :meth:`compute`, in feet, without lag.

        For sensors such as an ultrasonic one. None if no target was in view.
        """
        return self._immediate_distance

    def _in_view(self, now: float, x: float, y: float, angle: float) -> list[tuple[Sighting, VisionSimTarget]]:
        """Return the targets in view, each with its sighting."""
        in_view = []
        for target in self._targets:
            sighting = target.compute(now, x, y, angle)
            if sighting is None:
                continue
            _, _, offset, distance = sighting
            if self._nearest <= distance <= self._farthest and abs(offset) <= self._half_fov:
                in_view.append((sighting, target))
        return in_view

    def _frame_is_due(self, now: float) -> bool:
        if self._first_frame is None:
            self._first_frame, self._next_frame = now, 0
        elapsed = now - self._first_frame + _TICK
        if elapsed < self._next_frame * self._period:
            return False
        # On the camera's schedule; one period from now would make the frequency depend on the calls.
        self._next_frame = math.floor(elapsed / self._period) + 1
        return True

    def _show(self, seen: tuple[VisionSimTarget, ...]) -> None:
        if seen != self._seen and self._controller is not None:
            self._controller.draw_vision_targets(self._targets, seen)
        self._seen = seen
