"""What a camera that looks for targets would see, and when the robot would hear of it.

Positions are in feet, x to the right and y down, as `physics_controller.get_position` answers them; angles are
clockwise, from 0 = east.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Sequence
from typing import Protocol

from .parameters import ParameterError, finite, not_negative, positive

#: One target in one frame: (1, capture time in s, degrees clockwise from the camera's axis, feet); or, if a frame
#: shows none, (0, capture time, inf, 0).
Sighting = tuple[int, float, float, float]

# Robot time is counted in microseconds: what is due within this many seconds is due.
_TICK = 1e-6


class VisionSimTarget:
    """Something on the field that a camera can see from one side.

    Seen from 90 to 270 degrees means that the robot is to the west of it, from south through west to north.
    """

    def __init__(self, x: float, y: float, view_angle_start: float, view_angle_end: float) -> None:
        """
        :param x: position on the field, in feet
        :param y: position on the field, in feet, growing downwards
        :param view_angle_start: where the robot must be, as seen from the target: degrees, 0 = east, clockwise
        :param view_angle_end: clockwise from the start; 0 to 360 is all around
        :raises ParameterError: for what is not a number
        """
        self.x = finite(x, "x")
        self.y = finite(y, "y")
        self.view_angle_start = finite(view_angle_start, "view_angle_start")
        self.view_angle_end = finite(view_angle_end, "view_angle_end")

    def __repr__(self) -> str:
        return f"VisionSimTarget({self.x}, {self.y}, {self.view_angle_start}, {self.view_angle_end})"

    def compute(self, now: float, x: float, y: float, angle: float) -> Sighting | None:
        """See this target from the robot, with a camera that looks everywhere and infinitely far.

        `VisionSim` calls this for each of its targets: a subclass may move a target, or hide it.

        :param now: robot time, in seconds
        :param x: of the robot, in feet
        :param y: of the robot, in feet, growing downwards
        :param angle: of the robot, in radians, clockwise from east
        :returns: (1, `now`, offset in degrees, distance in feet), offsets to the right positive; None from where the
            target cannot be seen
        """
        if not self.faces(x, y):
            return None
        dx, dy = self.x - x, self.y - y
        offset = math.degrees(math.remainder(math.atan2(dy, dx) - angle, math.tau))
        return 1, now, offset, math.hypot(dx, dy)

    def faces(self, x: float, y: float) -> bool:
        """Whether (x, y) is where the target can be seen from, however far away."""
        span = self.view_angle_end - self.view_angle_start
        span = 360 if abs(span) >= 360 else span % 360
        bearing = math.degrees(math.atan2(y - self.y, x - self.x))
        return (bearing - self.view_angle_start) % 360 <= span


class DrawsVisionTargets(Protocol):
    """What is asked of a physics controller."""

    def draw_vision_targets(self, targets: Sequence[VisionSimTarget], seen: Sequence[VisionSimTarget], /) -> None:
        """Show where the targets are, and which of them are in view."""


class VisionSim:
    """A camera in the robot's centre, looking forward, and what processes its images.

    It takes frames at a constant frequency, beginning with the first call of :meth:`compute`; each frame shows what
    is in view at the first call when it is due or past, and is answered by the first call when `data_lag` has gone
    by since. If several have arrived by then, the newest is answered, as from a table that holds the latest value.
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
        :param targets: what there is to see
        :param camera_fov: the camera's field of view, in degrees, half of it to each side
        :param view_dst_start: nearer than this, in feet, targets cannot be seen
        :param view_dst_end: farther than this, in feet, targets cannot be seen
        :param data_frequency: frames per second
        :param data_lag: seconds from the taking of a frame until the robot has its data
        :param physics_controller: if given, shows the targets on the field
        :raises ParameterError: for measures that cannot be
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
        :param x: of the robot, in feet
        :param y: of the robot, in feet, growing downwards
        :param angle: of the robot, in radians, clockwise from east
        :returns: None while there is nothing new; else a frame: for each target in view (1, capture time, offset in
            degrees, distance in feet), the least offset first, where offsets to the right are positive; or, if it
            shows none, a list of one (0, capture time, inf, 0)
        :raises ParameterError: for a position that is not finite
        """
        if not math.isfinite(x + y + angle):
            raise ParameterError(f"x, y, angle = {x!r}, {y!r}, {angle!r}: must be finite numbers")
        in_view = self._in_view(now, x, y, angle)
        self._show(tuple(target for _, target in in_view))
        in_view.sort(key=lambda sight: abs(sight[0][2]))
        self._immediate_distance = in_view[0][0][3] if in_view else None
        if self._first_frame is not None and now < self._first_frame:
            self.dont_compute()  # another run has begun
        if self._frame_is_due(now):
            frame = [sighting for sighting, _ in in_view]
            self._in_flight.append(frame or [(0, now, math.inf, 0)])
        arrived = None
        while self._in_flight and self._in_flight[0][0][1] + self._lag <= now + _TICK:
            arrived = self._in_flight.popleft()
        return arrived

    def dont_compute(self) -> None:
        """Call this instead while vision processing is disabled: what was under way is lost."""
        self._in_flight.clear()
        self._first_frame = None
        self._show(())

    def get_immediate_distance(self) -> float | None:
        """How far away the target straight ahead was at the last :meth:`compute`, in feet, without any lag.

        For sensors such as an ultrasonic one. Straightest, if there are several; None if none was in view.
        """
        return self._immediate_distance

    def _in_view(self, now: float, x: float, y: float, angle: float) -> list[tuple[Sighting, VisionSimTarget]]:
        """Each target in view, with what is seen of it."""
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
        # On the camera's schedule, not one period from now, or its frequency would depend on how often we are called.
        self._next_frame = math.floor(elapsed / self._period) + 1
        return True

    def _show(self, seen: tuple[VisionSimTarget, ...]) -> None:
        if seen != self._seen and self._controller is not None:
            self._controller.draw_vision_targets(self._targets, seen)
        self._seen = seen
