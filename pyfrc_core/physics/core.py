"""The interface of a project's ``physics.py``: the class it must contain, and the object that moves the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from ..config.document import document_of
from ..config.resolve import resolve_document
from ..config.sim import SimConfig
from ..errors import RobotCodeError
from ..hal import HalData, rows
from ..wpi import dashboards, geometry
from .drivetrains import DriveVector
from .parameters import ParameterError
from .pose import METRES_PER_FOOT, Pose, along_arc, walls_of

if TYPE_CHECKING:
    from ..hal.fields import DeviceField
    from .visionsim import VisionSimTarget

__all__ = ["PhysicsEngine", "PhysicsInitException", "PhysicsInterface"]

_NO_MOVE = geometry.Transform2d()
#: Poses that differ by less than this are equal to WPILib, in metres and radians.
_LEAST_MOVE = 1e-9


class PhysicsInitException(RobotCodeError):
    """The project's ``physics.py`` has no valid class `PhysicsEngine` with a method `update_sim`."""


class PhysicsEngine:
    """The class that your ``physics.py`` must contain, with this name and these methods.

    You may inherit from this class; then `update_sim` may be absent, too. The engine is created before the robot, so
    that `initialize` can set the robot's inputs. If its constructor also takes the robot, or its `update_sim` takes
    ``(now, tm_diff)`` as in current pyfrc, it is created after the robot's `robotInit`.

    :param physics_controller: moves the robot on the field
    """

    def __init__(self, physics_controller: PhysicsInterface) -> None:
        self.physics_controller = physics_controller

    def initialize(self, hal_data: HalData) -> None:
        """Called before the robot starts; optional.

        Inputs keep what is set here when the robot creates their devices; a gyro starts at 0.

        :param hal_data: the robot's inputs and outputs
        """

    def update_sim(self, hal_data: HalData, now: float, tm_diff: float) -> None:
        """Called every 20 ms of robot time, after the robot's loop (every 10 ms for robots with faster loops).

        While the robot is disabled, outputs read as off, whatever its code sets.

        :param hal_data: the robot's inputs and outputs
        :param now: the robot time, in seconds
        :param tm_diff: the time since the last call, in seconds
        """


class PhysicsField(dashboards.Field2d):
    """The field of one run, which is distinguished by its class from those that robot code shows."""


class PhysicsInterface:
    """Moves the robot on the field, and turns its gyros with it.

    There is one pose with two views. `get_position` is pyfrc's: feet, clockwise, x to the right and y
    downwards from the field's top left corner. `get_pose` is WPILib's: metres, counter-clockwise, x to the right and y
    upwards from the bottom left corner.

    :param robot_path: the directory of the robot's code
    :param fake_time: control over robot time, for physics that read it
    :param config_obj: the contents of ``sim/config.json``: the parsed file as a dict, or its resolved values
    :param hal_data: the robot's inputs and outputs, with its gyros; None leaves gyros unchanged
    """

    def __init__(
        self,
        robot_path: str | Path,
        fake_time: object,
        config_obj: SimConfig | Mapping[str, object],
        hal_data: HalData | None = None,
    ) -> None:
        self.robot_path = str(robot_path)
        self.fake_time = fake_time
        #: The field as dashboards show it; `setRobotPose` moves the robot.
        self.field: dashboards.Field2d = PhysicsField()
        #: The targets of a `VisionSim`, and those that it sees now.
        self.vision_targets: tuple[VisionSimTarget, ...] = ()
        self.vision_targets_in_view: tuple[VisionSimTarget, ...] = ()
        config = config_obj if isinstance(config_obj, SimConfig) else resolve_document(config_obj)
        #: ``sim/config.json`` as a plain dict, with the default of each key that is not in the file:
        #: ``config_obj["pyfrc"]["robot"]["w"]``.
        self.config_obj = document_of(config) if isinstance(config_obj, SimConfig) else config_obj
        self._hal_data = hal_data
        self._pose: Pose
        self._shown: geometry.Pose2d
        self._device_gyros: list[str] = []
        self._analog_rate, self._device_rate = _Rate(), _Rate()
        self._height = config.field.h
        self._walls = walls_of(config) if config.field.walls else None
        start = config.start
        self._place(Pose(start.x, start.y, math.radians(start.angle)))

    # -- feet, clockwise -----------------------------------------------------------------------------------------

    @overload
    def drive(self, speed: float, rotation_speed: float, tm_diff: float) -> geometry.Pose2d: ...

    @overload
    def drive(self, speed: geometry.ChassisSpeeds | DriveVector, tm_diff: float, /) -> geometry.Pose2d: ...

    @overload
    def drive(self, speed: geometry.ChassisSpeeds | DriveVector, *, tm_diff: float) -> geometry.Pose2d: ...

    def drive(
        self,
        speed: float | geometry.ChassisSpeeds | DriveVector,
        rotation_speed: float | None = None,
        tm_diff: float | None = None,
    ) -> geometry.Pose2d:
        """Turn the robot, then move it forward. This also works while it is disabled, since a robot keeps rolling.

        There are two more forms, which move the robot along the arc of constant velocities: ``drive(vector, tm_diff)``
        with the result of the drivetrain functions for mecanum and swerve; and ``drive(ChassisSpeeds, tm_diff)``, as
        since 2020, in metres and counter-clockwise, which does not turn gyros.

        :param speed: the robot's speed forward, in ft/s
        :param rotation_speed: clockwise, in radians/s
        :param tm_diff: the duration in seconds, as passed to `update_sim`
        :returns: the robot's new pose
        """
        if isinstance(speed, (geometry.ChassisSpeeds, DriveVector)):
            time = rotation_speed if tm_diff is None else tm_diff  # the second positional argument
            if time is None or (rotation_speed is not None and tm_diff is not None):
                raise TypeError(f"drive({type(speed).__name__}, tm_diff) takes a time, in seconds, and nothing else")
            if isinstance(speed, DriveVector):
                right, forward, clockwise = speed
                pose = self._move_along(forward * time, right * time, clockwise * time)
                self._turn_analog_gyros(clockwise * time)
                return pose
            turn = -speed.omega * time
            forward, right = speed.vx / METRES_PER_FOOT * time, -speed.vy / METRES_PER_FOOT * time
            return self._move_along(forward, right, turn)
        if rotation_speed is None or tm_diff is None:
            raise TypeError(
                "drive(speed, rotation_speed, tm_diff) takes three numbers, and drive(speeds, tm_diff) ChassisSpeeds "
                f"and a time, not a {type(speed).__name__}"
            )
        return self._drive(speed * tm_diff, 0.0, rotation_speed * tm_diff)

    def vector_drive(self, vx: float, vy: float, vw: float, tm_diff: float) -> None:
        """Turn the robot, then move it with a constant velocity relative to itself.

        :param vx: speed to the robot's right, in ft/s
        :param vy: speed forward, in ft/s
        :param vw: clockwise, in radians/s
        :param tm_diff: the duration, in seconds
        """
        self._drive(vy * tm_diff, vx * tm_diff, vw * tm_diff)

    def distance_drive(self, x: float, y: float, angle: float) -> None:
        """Turn the robot, then move it by a distance relative to itself.

        As with `move_robot`, moves of less than a nanometre and a billionth of a radian are ignored.

        :param x: feet forward
        :param y: feet to the right
        :param angle: radians, clockwise
        """
        _check(x, y, angle)
        if max(abs(x) * METRES_PER_FOOT, abs(y) * METRES_PER_FOOT, abs(angle)) >= _LEAST_MOVE:
            self._turn_and_move(x, y, angle)

    def get_position(self) -> tuple[float, float, float]:
        """Return the robot's position (x, y, angle) in feet and radians; the angle is not limited to one turn."""
        pose = self._current()
        return pose.x, pose.y, pose.angle

    def get_offset(self, x: float, y: float) -> tuple[float, float]:
        """Return the distance to a position in feet, and the direction from there to the robot.

        :returns: the distance, and degrees on the field, 0 = east, clockwise, from -180 to 180: the same whichever way
            the robot faces
        """
        pose = self._current()
        dx, dy = pose.x - x, pose.y - y
        return math.hypot(dx, dy), math.degrees(math.atan2(dy, dx))

    # -- gyros ---------------------------------------------------------------------------------------------------

    def add_device_gyro_channel(self, angle_key: str) -> None:
        """Turn a gyro with the robot, for every kind of move, and set its rate if it has one.

        :param angle_key: the name of its angle in ``hal_data['robot']``, in degrees clockwise, such as
            ``'navx_spi_4_angle'``
        """
        if angle_key not in self._device_gyros:
            self._device_gyros.append(angle_key)

    def add_analog_gyro_channel(self, ch: int) -> None:
        """Do nothing; no longer needed, since analog gyros turn with the robot."""

    def add_gyro_channel(self, ch: int) -> None:
        """Do nothing; no longer needed, since analog gyros turn with the robot."""

    # -- metres, counter-clockwise -------------------------------------------------------------------------------

    def move_robot(self, transform: geometry.Transform2d) -> geometry.Pose2d:
        """Move the robot relative to its pose. This also works while it is disabled, since a robot keeps rolling.

        Analog gyros are not turned. Moves of less than a nanometre and a billionth of a radian are ignored.

        :param transform: in metres, counter-clockwise, such as the result of `TankModel.calculate`
        :returns: the robot's new pose
        """
        if transform == _NO_MOVE:  # WPILib compares to a nanometre; most robots rest most of the time
            return self._move(0.0, 0.0, 0.0)
        if not isinstance(transform, geometry.Transform2d):
            raise TypeError(f"move_robot(transform) takes a Transform2d, not a {type(transform).__name__}")
        turn = transform.rotation().radians()
        return self._move(transform.x / METRES_PER_FOOT, -transform.y / METRES_PER_FOOT, -turn)

    def get_pose(self) -> geometry.Pose2d:
        """Return the robot's pose, in metres."""
        return dashboards.robot_pose(self.field)

    # -- drawing -------------------------------------------------------------------------------------------------

    def draw_vision_targets(self, targets: Sequence[VisionSimTarget], in_view: Sequence[VisionSimTarget]) -> None:
        """Show a camera's targets on the field, and those in view as a second object."""
        self.vision_targets, self.vision_targets_in_view = tuple(targets), tuple(in_view)
        for name, shown in (("vision targets", targets), ("vision targets in view", in_view)):
            dashboards.show_poses(self.field, name, [self._seen_in_metres(Pose(t.x, t.y, 0.0)) for t in shown])

    # -- the pose ------------------------------------------------------------------------------------------------

    def _drive(self, forward: float, right: float, turn: float) -> geometry.Pose2d:
        """Turn, then move, as pyfrc did in 2019: forward by the turn once more, and to the side as before the turn."""
        _check(forward, right, turn)
        cos, sin = math.cos(turn), math.sin(turn)
        return self._turn_and_move(forward * cos + right * sin, forward * sin + right * cos, turn)

    def _turn_and_move(self, forward: float, right: float, turn: float) -> geometry.Pose2d:
        cos, sin = math.cos(turn), math.sin(turn)
        pose = self._move(forward * cos - right * sin, forward * sin + right * cos, turn)
        self._turn_analog_gyros(turn)
        return pose

    def _move_along(self, forward: float, right: float, turn: float) -> geometry.Pose2d:
        """Move with constant velocities; without the turn, they would move the robot this far forward and right."""
        _check(forward, right, turn)
        return self._move(*along_arc(forward, right, turn), turn)

    def _move(self, forward: float, right: float, turn: float) -> geometry.Pose2d:
        _check(forward, right, turn)
        if (self._device_gyros or any(rows.gyros(numbered=False))) and self._hal_data is not None:
            degrees = math.degrees(turn)
            self._device_rate.turned += degrees
            angles = self._hal_data["robot"]
            for key in self._device_gyros:
                angles[key] = angles.get(key, 0.0) + degrees
            self._turn_gyros(degrees, numbered=False)
        pose = self._current()
        if not (forward or right or turn):  # at rest, no update for dashboards is needed
            return self._shown
        moved = pose.moved(forward, right, turn)
        return self._place(moved if self._walls is None else self._walls.keep_in(moved))

    def _turn_analog_gyros(self, turn: float) -> None:
        if turn and self._hal_data is not None:
            self._analog_rate.turned += math.degrees(turn)
            self._turn_gyros(math.degrees(turn), numbered=True)

    def _gyros(self, numbered: bool) -> Iterator[tuple[Any, DeviceField]]:
        """Return the gyros of `hal_data`, with a field of each that turns with the robot.

        :param numbered: whether those at channels of the controller; else its own ones
        """
        if (tree := self._hal_data) is None:
            return
        for kind, field in rows.gyros(numbered):
            for gyro in tree[kind.name] if numbered else [tree[kind.name]]:
                yield gyro, field

    def _turn_gyros(self, degrees: float, numbered: bool) -> None:
        """Turn the gyros at channels of the controller, or its own ones."""
        for gyro, field in self._gyros(numbered):
            if field.heading:
                gyro[field.name] += degrees * field.heading

    def _set_rates(self, degrees: float, numbered: bool) -> None:
        """Set how fast they turn clockwise, in degrees per second."""
        for gyro, field in self._gyros(numbered):
            if field.turning:
                gyro[field.name] = degrees * field.turning

    def update_rates(self, tm_diff: float) -> None:
        """Set the gyros' rates after `update_sim`, in degrees/s, from the angles that it has turned them by."""
        if self._hal_data is None:
            return
        if self._analog_rate.update(tm_diff):
            self._set_rates(self._analog_rate.value, numbered=True)
        if self._device_rate.update(tm_diff):
            self._set_rates(self._device_rate.value, numbered=False)
            values = self._hal_data["robot"]
            for key in self._device_gyros:
                rate_key = f"{key.removesuffix('angle')}rate"
                if rate_key in values:
                    values[rate_key] = self._device_rate.value

    def _current(self) -> Pose:
        """Return the pose, with changes that were made on the `field`."""
        shown = dashboards.robot_pose(self.field)
        if shown == self._shown:
            return self._pose
        self._shown = shown
        turned = -shown.rotation().radians()
        self._pose = Pose(shown.x / METRES_PER_FOOT, self._height - shown.y / METRES_PER_FOOT, turned)
        return self._pose

    def _place(self, pose: Pose) -> geometry.Pose2d:
        shown = self._seen_in_metres(pose)
        self._pose, self._shown = pose, shown
        dashboards.place_robot(self.field, shown)
        return shown

    def _seen_in_metres(self, pose: Pose) -> geometry.Pose2d:
        return geometry.pose(pose.x * METRES_PER_FOOT, (self._height - pose.y) * METRES_PER_FOOT, -pose.angle)


class _Rate:
    """The rate of gyros, from the angles that they turn by."""

    def __init__(self) -> None:
        #: Degrees since the last update.
        self.turned = 0.0
        #: Degrees/s.
        self.value = 0.0

    def update(self, time: float) -> bool:
        """Take in what was turned in this time, in seconds; return whether the rate has changed."""
        before, self.value, self.turned = self.value, self.turned / time, 0.0
        return self.value != before


def _check(forward: float, right: float, turn: float) -> None:
    """Raise `ParameterError` unless all numbers are finite: NaN would remain in the robot's pose forever."""
    if not math.isfinite(forward + right + turn):
        raise ParameterError(f"the robot cannot move by {forward:g} ft forward, {right:g} ft right, {turn:g} rad")
