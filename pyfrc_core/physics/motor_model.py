"""Compute the speed of one side of a tank drive from the voltage of its motors.

The equation is that of Noah Gleason's and Eli Barnett's motor characterization whitepaper (as in WPILib's drivetrain
characterization): ``V = kv * velocity + ka * acceleration + vintercept``, where the friction's `vintercept` opposes the
voltage. While the voltage is constant, its solution is one exponential, which is computed here: a step of any length is
exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from .motor_cfgs import MotorModelConfig
from .parameters import ParameterError, finite, not_negative, positive, within_full_power
from .quantities import magnitude
from .units import units

if TYPE_CHECKING:
    from .units import Quantity


class MotorModel:
    """Motor model of the `TankModel`, which creates its own.

    `position`, `velocity`, `kv`, `ka` and `vintercept` may be set at any time: the next step continues from there. So
    may `acceleration`, which the next step computes again.

    :param motor_config: the specification of the motor
    :param kv: voltage per speed (`units.tm_kv`), computed or measured for the robot
    :param ka: voltage per acceleration (`units.tm_ka`)
    :param vintercept: the lowest voltage that overcomes steady friction (`units.volt`)
    :raises WrongDimension: for a parameter with a unit of another dimension
    :raises ParameterError: for an impossible value, such as a negative `ka`
    """

    # `__dict__` allows tests to set any attribute, or replace a method.
    __slots__ = (
        "__dict__",
        "__weakref__",
        "_friction_speed",
        "_full_speed",
        "_tm_diff",
        "_volts",
        "_volts_of_friction",
        "_volts_per_acceleration",
        "_volts_per_speed",
        "kept",
        "lag",
        "on_change",
        "position",
        "reach",
        "steady",
        "time_constant",
    )

    #: Current computed position (in ft)
    position: float
    #: The steady speed for the motor value (in ft/s)
    steady: float
    #: The current speed minus the steady speed (in ft/s)
    lag: float
    #: The time in which the difference to the steady speed falls to 1/e (in s)
    time_constant: float
    #: The part of the lag that remains after a step of the prepared length
    kept: float
    #: The distance that a lag of 1 ft/s adds in such a step (in ft)
    reach: float
    #: Called after a change of an attribute from which others were computed
    on_change: Callable[[], None] | None

    def __init__(self, motor_config: MotorModelConfig, kv: Quantity, ka: Quantity, vintercept: Quantity) -> None:
        self.lag = self.position = self.steady = self._tm_diff = 0.0
        self.on_change = None
        self._volts_per_speed = _volts_per_speed(kv)
        self._volts_per_acceleration = _volts_per_acceleration(ka)
        self._volts_of_friction = _volts_of_friction(vintercept)
        self._volts = nominal_volts(motor_config)
        self._compute_constants()

    def _compute_constants(self) -> None:
        # Speeds instead of voltages: the steady speed of each, and the time constant.
        self._full_speed = self._volts / self._volts_per_speed
        self._friction_speed = self._volts_of_friction / self._volts_per_speed
        self.time_constant = self._volts_per_acceleration / self._volts_per_speed
        self.prepare(self._tm_diff)
        if self.on_change is not None:
            self.on_change()

    @property
    def kv(self) -> Quantity:
        """Voltage per speed (`units.tm_kv`)."""
        volts: Quantity = self._volts_per_speed * units.tm_kv
        return volts

    @kv.setter
    def kv(self, kv: Quantity) -> None:
        self._volts_per_speed = _volts_per_speed(kv)
        self._compute_constants()

    @property
    def ka(self) -> Quantity:
        """Voltage per acceleration (`units.tm_ka`)."""
        volts: Quantity = self._volts_per_acceleration * units.tm_ka
        return volts

    @ka.setter
    def ka(self, ka: Quantity) -> None:
        self._volts_per_acceleration = _volts_per_acceleration(ka)
        self._compute_constants()

    @property
    def vintercept(self) -> Quantity:
        """The lowest voltage that overcomes steady friction (`units.volt`)."""
        volts: Quantity = self._volts_of_friction * units.volt
        return volts

    @vintercept.setter
    def vintercept(self, vintercept: Quantity) -> None:
        self._volts_of_friction = _volts_of_friction(vintercept)
        self._compute_constants()

    @property
    def velocity(self) -> float:
        """Current computed velocity (in ft/s)."""
        return self.steady + self.lag

    @velocity.setter
    def velocity(self, velocity: float) -> None:
        self.lag = finite(velocity, "velocity") - self.steady

    @property
    def acceleration(self) -> float:
        """Current computed acceleration (in ft/s^2)."""
        return 0.0 - self.lag / self.time_constant

    @acceleration.setter
    def acceleration(self, acceleration: float) -> None:
        velocity = self.velocity
        self.lag = -finite(acceleration, "acceleration") * self.time_constant
        self.steady = velocity - self.lag
        if self.on_change is not None:
            self.on_change()

    def compute(self, motor_pct: float, tm_diff: float) -> float:
        """Advance by `tm_diff` seconds with this motor value.

        :param motor_pct: power of the motor, -1 to 1, forward positive; values beyond count as full power
        :param tm_diff: seconds since the last call
        :returns: the new velocity, in ft/s
        :raises ParameterError: for NaN, or a negative time
        """
        self.apply(motor_pct, "motor_pct")
        if tm_diff != self._tm_diff:
            self.prepare(tm_diff)
        self.position += self.steady * tm_diff + self.lag * self.reach
        self.lag *= self.kept
        return self.velocity

    def apply(self, motor_pct: float, parameter: str) -> None:
        """Set the motor value of the following steps; `parameter` is its name in errors."""
        steady = self._full_speed * within_full_power(motor_pct, parameter)
        friction = self._friction_speed
        if steady > friction:
            steady -= friction
        elif steady < -friction:
            steady += friction
        else:
            steady = 0.0
        self.lag = self.velocity - steady
        self.steady = steady

    def prepare(self, tm_diff: float) -> None:
        """Set the length of the following steps, in seconds."""
        tm_diff = not_negative(tm_diff, "tm_diff")
        self._tm_diff = tm_diff
        gained = -math.expm1(-tm_diff / self.time_constant)
        self.kept = 1.0 - gained
        self.reach = self.time_constant * gained


def _volts_per_speed(kv: Quantity) -> float:
    return positive(magnitude(kv, "volt * second / foot", "kv"), "kv")


def _volts_per_acceleration(ka: Quantity) -> float:
    return positive(magnitude(ka, "volt * second ** 2 / foot", "ka"), "ka")


def _volts_of_friction(vintercept: Quantity) -> float:
    return not_negative(magnitude(vintercept, "volt", "vintercept"), "vintercept")


def nominal_volts(motor_config: MotorModelConfig) -> float:
    """Return the voltage of a motor value of 1.

    :raises ParameterError: when the argument is not a motor configuration
    """
    if not isinstance(motor_config, MotorModelConfig):
        raise ParameterError(
            f"motor_config = {motor_config!r}: must be a motor configuration",
            remedy="use one of pyfrc.physics.motor_cfgs, such as MOTOR_CFG_CIM, or create a MotorModelConfig",
        )
    return positive(magnitude(motor_config.nominalVoltage, "volt", "nominalVoltage"), "nominalVoltage")
