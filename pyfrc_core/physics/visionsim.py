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
        #: In radians, as `view_angle_end`.
        self.view_angle_start = math.radians(finite(view_angle_start, "view_angle_start"))
        self.view_angle_end = math.radians(finite(view_angle_end, "view_angle_end"))
        #: The camera, set by `VisionSim`: the distances at which it sees the target, in feet, and half of its field of
        #: view, in radians.
        self.view_dst_start, self.view_dst_end = 0.0, math.inf
        self.fov2 = math.pi

    def __repr__(self) -> str:
        angles = f"{math.degrees(self.view_angle_start):g}, {math.degrees(self.view_angle_end):g}"
        return f"VisionSimTarget({self.x}, {self.y}, {angles})"

    def compute(self, now: float, x: float, y: float, angle: float) -> Sighting | None:
        """Return what the camera on the robot sees of this target.

        `VisionSim` calls this for each of its targets: a subclass may move a target, or hide it.

        :param now: robot time, in seconds
        :param x: the robot's position, in feet
        :param y: the robot's position, in feet, increasing downwards
        :param angle: the robot's angle, in radians, clockwise from east
        :returns: (1, `now`, offset in degrees, distance in feet), with offsets to the right positive; None where the
            target cannot be seen
        """
        dx, dy = self.x - x, self.y - y
        distance = math.hypot(dx, dy)
        if not self.view_dst_start <= distance <= self.view_dst_end or not self.faces(x, y):
            return None
        offset = math.remainder(math.atan2(dy, dx) - angle, math.tau)
        return (1, now, math.degrees(offset), distance) if abs(offset) <= self.fov2 else None

    def faces(self, x: float, y: float) -> bool:
        """Return whether the target can be seen from (x, y), at any distance."""
        span = self.view_angle_end - self.view_angle_start
        span = math.tau if abs(span) >= math.tau else span % math.tau
        bearing = math.atan2(y - self.y, x - self.x)
        return (bearing - self.view_angle_start) % math.tau <= span


class DrawsVisionTargets(Protocol):
    """The part of a physics controller that `VisionSim` uses."""

    def draw_vision_targets(self, targets: Sequence[VisionSimTarget], seen: Sequence[VisionSimTarget], /) -> None:
        """Show the targets, and which of them are in view."""


class VisionSim:
    """A camera in the robot's centre, looking forward, with its image processing.

    The first call of :meth:`compute` takes a frame, as does each call at which more than `update_period` seconds have
    passed since the last frame: with 15 frames per second and a call every 20 ms, every 80 ms. Its data are returned by
    the first call at which more than `data_lag` seconds have passed.
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
        half_fov = math.radians(positive(camera_fov, "camera_fov") / 2)
        nearest, farthest = not_negative(view_dst_start, "view_dst_start"), finite(view_dst_end, "view_dst_end")
        if farthest < nearest:
            raise ParameterError(f"view_dst_end = {view_dst_end!r} is below view_dst_start = {view_dst_start!r}")
        for target in self._targets:
            if not isinstance(target, VisionSimTarget):
                raise ParameterError(
                    f"targets: {target!r} is not a target", remedy="make each with VisionSim.Target(...)"
                )
            target.fov2, target.view_dst_start, target.view_dst_end = half_fov, nearest, farthest
        #: Seconds between two frames, and from a frame to its arrival at the robot; both may be changed.
        self.update_period = 1 / positive(data_frequency, "data_frequency")
        self.data_lag = not_negative(data_lag, "data_lag")
        self._controller = physics_controller

        self._last_frame = -math.inf
        self._in_flight: deque[list[Sighting]] = deque()
        self._immediate_distance: float | None = 0
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
        sights = [(sighting, each) for each in self._targets if (sighting := each.compute(now, x, y, angle))]
        self._show(tuple(target for _, target in sights))
        in_view = sorted((sighting for sighting, _ in sights), key=lambda sighting: abs(sighting[2]))
        self._immediate_distance = in_view[0][3] if in_view else None
        if now < self._last_frame:  # a new run has started
            self.dont_compute()
            self._last_frame = -math.inf
        if now - self._last_frame > self.update_period:
            self._last_frame = now
            self._in_flight.append(in_view or [(0, now, math.inf, 0)])
        if self._in_flight and now - self._in_flight[0][0][1] > self.data_lag:
            return self._in_flight.popleft()
        return None

    def dont_compute(self) -> None:
        """Call this instead while vision processing is disabled: frames that have not arrived are lost."""
        self._in_flight.clear()
        self._show(())

    def get_immediate_distance(self) -> float | None:
        """Return the distance of the most central target at the last :meth:`compute`, in feet, without lag.

        For sensors such as an ultrasonic one. 0 before the first :meth:`compute`; None if no target was in view.
        """
        return self._immediate_distance

    def _show(self, seen: tuple[VisionSimTarget, ...]) -> None:
        if seen != self._seen and self._controller is not None:
            self._controller.draw_vision_targets(self._targets, seen)
        self._seen = seen
