"""A model of a tank drive: compute the robot's motion from its motors' values."""

from __future__ import annotations

import logging
import math
import warnings
from math import cos, sin
from typing import TYPE_CHECKING

from ..wpi import geometry
from .arc import MOST_BEND, MOST_TIME_CONSTANTS, MOST_TURN, SideMotion, along, bow
from .motor_cfgs import MotorModelConfig
from .motor_model import MotorModel, nominal_volts
from .parameters import ParameterError, finite, positive
from .quantities import magnitude
from .units import units

if TYPE_CHECKING:
    from .units import Quantity

__all__ = ["MotorModel", "TankModel"]

logger = logging.getLogger("pyfrc.physics")

# Bound once: `calculate` is called in each step of physics.
_transform = geometry.transform_in_feet

MOST_TURN_SQUARED, MOST_BEND_SQUARED = MOST_TURN**2, MOST_BEND**2


class TankModel:
    """A tank drive whose sides accelerate according to their motors; wheels do not slip along the ground.

    Use the constructor if you have measured kv, ka and vintercept, and `theory` if you have not. All parameters are
    pint quantities in any unit; positions are in feet, velocities in ft/s. A step of any length is exact.

    The heading comes from the moment of inertia: the sides' difference in acceleration, at the lever of half a
    wheelbase, turns the whole mass, so it does not depend on the wheels' distances alone. With ``model.inertia = mass *
    x_wheelbase**2 / 2`` the heading agrees exactly with wheels that do not slip at all: ``(l_position - r_position) /
    x_wheelbase`` radians clockwise.

    `inertia`, `bm`, and the positions and velocities of both sides may be set at any time: the next step continues from
    there.

    :param motor_config: specification of the motors
    :param robot_mass: mass of the robot
    :param x_wheelbase: distance between the left and the right wheels
    :param robot_width: with bumpers; with the length it gives the moment of inertia
    :param robot_length: with bumpers
    :param l_kv: left side: voltage per speed (`units.tm_kv`)
    :param l_ka: left side: voltage per acceleration (`units.tm_ka`)
    :param l_vi: left side: the lowest voltage that overcomes steady friction
    :param r_kv: right side, like `l_kv`
    :param r_ka: right side, like `l_ka`
    :param r_vi: right side, like `l_vi`
    :param timestep: ignored; accepted for models from when the motion was computed in small steps
    :raises WrongDimension: for a parameter with a unit of another dimension, such as a mass in feet
    :raises ParameterError: for an impossible value, such as a negative mass
    """

    # `__dict__` allows tests to set any attribute, or replace a method.
    __slots__ = (
        "__dict__",
        "__weakref__",
        "_inertia",
        "_l_motor",
        "_lmotor",
        "_pull",
        "_r_motor",
        "_rmotor",
        "_step",
        "_tm_diff",
    )

    def __init__(
        self,
        motor_config: MotorModelConfig,
        robot_mass: Quantity,
        x_wheelbase: Quantity,
        robot_width: Quantity,
        robot_length: Quantity,
        l_kv: Quantity,
        l_ka: Quantity,
        l_vi: Quantity,
        r_kv: Quantity,
        r_ka: Quantity,
        r_vi: Quantity,
        timestep: Quantity = 5 * units.millisecond,
    ) -> None:
        mass = positive(magnitude(robot_mass, "pound", "robot_mass"), "robot_mass")
        wheelbase = positive(magnitude(x_wheelbase, "foot", "x_wheelbase"), "x_wheelbase")
        width = positive(magnitude(robot_width, "foot", "robot_width"), "robot_width")
        length = positive(magnitude(robot_length, "foot", "robot_length"), "robot_length")
        positive(magnitude(timestep, "second", "timestep"), "timestep")
        logger.info(
            "Robot base: %.1fx%.1f in frame, %.1f ft wheelbase, %.1f lb mass", width * 12, length * 12, wheelbase, mass
        )

        self._lmotor = MotorModel(motor_config, l_kv, l_ka, l_vi)
        self._rmotor = MotorModel(motor_config, r_kv, r_ka, r_vi)
        self._lmotor.on_change = self._rmotor.on_change = self._reset_step
        self._l_motor = self._r_motor = self._tm_diff = 0.0

        self._pull = 0.5 * wheelbase * mass
        self._set_inertia(mass * (width**2 + length**2) / 12)  # a homogeneous plate

    @classmethod
    def theory(
        cls,
        motor_config: MotorModelConfig,
        robot_mass: Quantity,
        gearing: float,
        nmotors: int = 1,
        x_wheelbase: Quantity = 21.0 * units.inch,
        robot_width: Quantity = 27.5 * units.inch,
        robot_length: Quantity = 36.5 * units.inch,
        wheel_diameter: Quantity = 6 * units.inch,
        vintercept: Quantity = 1.3 * units.volt,
        timestep: Quantity = 5 * units.millisecond,
    ) -> TankModel:
        """Return the model of a robot whose kv and ka have not been measured, from the motors' data sheet::

            velocity_max = freeSpeed * pi * wheel_diameter / gearing
            acceleration_max = 2 * nmotors * stallTorque * gearing / (wheel_diameter * robot_mass)

            kv = nominalVoltage / velocity_max
            ka = nominalVoltage / acceleration_max

        :param motor_config: specification of the motors; a free speed in radians, such as one in pint's `rpm`, is taken
            for turns, with a warning
        :param robot_mass: mass of the robot
        :param gearing: gear ratio: for 10.74:1, 10.74
        :param nmotors: number of drive motors. With all of them, both sides together, the model accelerates as the
            robot does. With those of one side, as the documentation of 2019 says in one of two places, half as fast
        :param x_wheelbase: distance between the left and the right wheels
        :param robot_width: with bumpers
        :param robot_length: with bumpers
        :param wheel_diameter: diameter of the wheels
        :param vintercept: the lowest voltage that overcomes steady friction
        :param timestep: ignored, as in the constructor
        :raises WrongDimension: for a parameter with a unit of another dimension
        :raises ParameterError: for an impossible value, such as a gearing of zero
        """
        volts = nominal_volts(motor_config)
        free = positive(magnitude(motor_config.freeSpeed, "1 / second", "freeSpeed"), "freeSpeed")
        _warn_of_radians(motor_config.freeSpeed)
        stall = positive(
            magnitude(motor_config.stallTorque, "pound * foot ** 2 / second ** 2", "stallTorque"), "stallTorque"
        )
        mass = positive(magnitude(robot_mass, "pound", "robot_mass"), "robot_mass")
        diameter = positive(magnitude(wheel_diameter, "foot", "wheel_diameter"), "wheel_diameter")
        ratio = positive(gearing, "gearing")
        if positive(nmotors, "nmotors") % 1:
            raise ParameterError(f"nmotors = {nmotors!r}: must be a whole number of motors")

        speed = free * math.pi * diameter / ratio
        acceleration = 2 * nmotors * stall * ratio / (diameter * mass)
        kv, ka = volts / speed, volts / acceleration
        logger.info(
            "Motor config: %d %s motors @ %.2f gearing with %.1f in diameter wheels",
            nmotors,
            motor_config.name,
            ratio,
            diameter * 12,
        )
        logger.info("- Theoretical: vmax=%.3f ft/s, amax=%.3f ft/s^2, kv=%.3f, ka=%.3f", speed, acceleration, kv, ka)
        side = kv * units.tm_kv, ka * units.tm_ka, vintercept
        return cls(motor_config, robot_mass, x_wheelbase, robot_width, robot_length, *side, *side, timestep)

    @property
    def inertia(self) -> Quantity:
        """Moment of inertia, [mass] * [length]**2: that of a plate with the robot's mass and size, unless you set it.

        :raises WrongDimension: when set in another unit
        """
        inertia: Quantity = self._inertia * units.pound * units.foot**2
        return inertia

    @inertia.setter
    def inertia(self, inertia: Quantity) -> None:
        self._set_inertia(positive(magnitude(inertia, "pound * foot ** 2", "inertia"), "inertia"))

    def _set_inertia(self, inertia: float) -> None:
        self._inertia = inertia
        self._prepare(self._tm_diff)

    @property
    def bm(self) -> Quantity:
        """Half the wheelbase times the mass, [length] * [mass]: the lever of the sides' forces.

        :raises WrongDimension: when set in another unit
        """
        lever: Quantity = self._pull * units.foot * units.pound
        return lever

    @bm.setter
    def bm(self, lever: Quantity) -> None:
        self._pull = positive(magnitude(lever, "foot * pound", "bm"), "bm")
        self._prepare(self._tm_diff)

    def _reset_step(self) -> None:
        """Make the next step read the motors' values and constants again."""
        self._l_motor = self._r_motor = math.nan  # unlike any value
        self._prepare(self._tm_diff)

    @property
    def l_position(self) -> float:
        """The linear position of the left side wheel (in feet), forward positive."""
        return self._lmotor.position

    @l_position.setter
    def l_position(self, position: float) -> None:
        self._lmotor.position = finite(position, "l_position")

    @property
    def r_position(self) -> float:
        """The linear position of the right side wheel (in feet), forward positive."""
        return self._rmotor.position

    @r_position.setter
    def r_position(self, position: float) -> None:
        self._rmotor.position = finite(position, "r_position")

    @property
    def l_velocity(self) -> float:
        """The velocity of the left side (in ft/s), forward positive."""
        return self._lmotor.velocity

    @l_velocity.setter
    def l_velocity(self, velocity: float) -> None:
        self._lmotor.velocity = finite(velocity, "l_velocity")

    @property
    def r_velocity(self) -> float:
        """The velocity of the right side (in ft/s), forward positive."""
        return self._rmotor.velocity

    @r_velocity.setter
    def r_velocity(self, velocity: float) -> None:
        self._rmotor.velocity = finite(velocity, "r_velocity")

    def get_distance(self, l_motor: float, r_motor: float, tm_diff: float) -> tuple[float, float, float]:
        """Return how far the robot has moved, for `PhysicsInterface.distance_drive`.

        With more than one motor on a side, pass the value of one of them.

        :param l_motor: left motor value (-1 to 1); -1 is forward
        :param r_motor: right motor value (-1 to 1); 1 is forward
        :param tm_diff: seconds since the last call
        :returns: feet forward, feet to the right, both relative to the robot's previous pose, and radians clockwise
        :raises ParameterError: for NaN, or a negative time
        """
        # Physics spends most of its time here, so the function is not split. A motor's value and the length of a step
        # are mostly the same as in the previous step: values that depend on them are stored, and computed again only
        # after a change. NaN counts as a change.
        if l_motor != self._l_motor:
            self._lmotor.apply(-l_motor, "l_motor")
            self._l_motor = l_motor
        if r_motor != self._r_motor:
            self._rmotor.apply(r_motor, "r_motor")
            self._r_motor = r_motor
        if tm_diff != self._tm_diff:
            self._prepare(tm_diff)
        left, l_kept, l_reach, l_bow, right, r_kept, r_reach, r_bow, turning, lean, unlike, most_bend_squared = (
            self._step
        )

        # Both sides advance, as in `MotorModel.compute`.
        l_lag, r_lag = left.lag, right.lag
        left.lag = l_lag * l_kept
        right.lag = r_lag * r_kept
        l_moved = left.steady * tm_diff + l_lag * l_reach
        r_moved = right.steady * tm_diff + r_lag * r_reach
        left.position += l_moved
        right.position += r_moved

        # The heading: how far it turns, and how far each side's bow (see arc.py) bends the path.
        middle = 0.5 * (l_moved + r_moved)
        angle = turning * (l_moved - r_moved)
        l_bow *= l_lag
        r_bow *= r_lag
        bend = l_bow - r_bow
        half = 0.5 * angle
        if half == 0.0 == bend:
            return middle, 0.0, 0.0
        angle_squared = angle * angle
        if half == 0.0 or angle_squared > MOST_TURN_SQUARED or bend * bend > most_bend_squared:
            l_side = SideMotion(left.time_constant, left.steady, l_lag)
            r_side = SideMotion(right.time_constant, right.steady, r_lag)
            return *along(tm_diff, turning, l_side, r_side), angle

        # The chord of a circle, and the bows' series, in the direction of the chord. `sway` is the sideways part of a
        # bow: from the heading, and, integrated by parts, from the speed. 0.6 is half the mean square of a bow's form,
        # 0.025 half its second moment, and `lean` its first. The last two terms are for sides with different time
        # constants (`unlike`).
        sin_half = sin(half)
        cos_half = cos(half)
        l_sway = l_bow * r_moved
        r_sway = r_bow * l_moved
        sway = l_sway - r_sway
        ahead = middle * sin_half / half - sway * (0.6 * bend - lean * angle)
        aside = sway * (1.0 - 0.025 * angle_squared)
        if unlike:
            ahead += unlike * angle * (l_sway + r_sway) / 24.0
            aside += unlike * l_bow * r_bow / turning
        return ahead * cos_half - aside * sin_half, ahead * sin_half + aside * cos_half, angle

    def calculate(self, l_motor: float, r_motor: float, tm_diff: float) -> geometry.Transform2d:
        """Return how far the robot has moved, for `PhysicsInterface.move_robot`.

        With more than one motor on a side, pass the value of one of them.

        :param l_motor: left motor value (-1 to 1); 1 is forward
        :param r_motor: right motor value (-1 to 1); -1 is forward
        :param tm_diff: seconds since the last call
        :returns: metres forward and to the left, and the turn counter-clockwise
        :raises ParameterError: for NaN, or a negative time
        """
        x, y, angle = self.get_distance(-l_motor, -r_motor, tm_diff)
        return _transform(x, 0.0 - y, 0.0 - angle)

    def _prepare(self, tm_diff: float) -> None:
        """Store the values that depend on the length of the steps only: most steps are as long as the last one."""
        left, right = self._lmotor, self._rmotor
        left.prepare(tm_diff)
        right.prepare(tm_diff)
        # From d(omega)/dt = lever * mass * (l_acceleration - r_acceleration) / inertia, starting at rest: integrated
        # once, both sides give the rate of turn from the speeds; integrated twice, the angle from the positions.
        turning = self._pull / self._inertia
        l_tau, r_tau = left.time_constant, right.time_constant
        l_passed, r_passed = tm_diff / l_tau, tm_diff / r_tau
        self._step = (
            left,
            left.kept,
            left.reach,
            turning * bow(tm_diff, l_tau, left.reach),
            right,
            right.kept,
            right.reach,
            turning * bow(tm_diff, r_tau, right.reach),
            turning,
            (l_passed + r_passed) / 120,
            (l_passed - r_passed) / 5,
            MOST_BEND_SQUARED if max(l_passed, r_passed) <= MOST_TIME_CONSTANTS else -1.0,
        )
        self._tm_diff = tm_diff


def _warn_of_radians(free_speed: Quantity) -> None:
    """Warn of a free speed that counts radians: it is taken for turns, as in 2019."""
    if "radian" in str(free_speed.to_root_units().units):
        warnings.warn(
            f"freeSpeed = {free_speed} counts radians, as all of pint's units of rotation do, but is taken for turns: "
            "the robot is 6.28 times as fast. Use units.cpm, counts per minute.",
            stacklevel=3,
        )
