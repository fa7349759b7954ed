"""Functions that were replaced by drivetrain classes in 2018."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from .deadzones import DeadzoneCallable
from .drivetrains import DriveVector, FourMotorDrivetrain, MecanumDrivetrain, TwoMotorDrivetrain

if TYPE_CHECKING:
    from pint import Quantity


def two_motor_drivetrain(
    l_motor: float,
    r_motor: float,
    x_wheelbase: float | Quantity[Any] = 2,
    speed: float | Quantity[Any] = 5,
    deadzone: DeadzoneCallable | None = None,
) -> tuple[float, float]:
    """Return the result of :class:`TwoMotorDrivetrain`'s `get_vector`. Deprecated since 2018.2.0: use that class."""
    _deprecated("two_motor_drivetrain", "TwoMotorDrivetrain")
    return TwoMotorDrivetrain(x_wheelbase, speed, deadzone).get_vector(l_motor, r_motor)


def four_motor_drivetrain(
    lr_motor: float,
    rr_motor: float,
    lf_motor: float,
    rf_motor: float,
    x_wheelbase: float | Quantity[Any] = 2,
    speed: float | Quantity[Any] = 5,
    deadzone: DeadzoneCallable | None = None,
) -> tuple[float, float]:
    """Return the result of :class:`FourMotorDrivetrain`'s `get_vector`. Deprecated since 2018.2.0: use that class."""
    _deprecated("four_motor_drivetrain", "FourMotorDrivetrain")
    return FourMotorDrivetrain(x_wheelbase, speed, deadzone).get_vector(lr_motor, rr_motor, lf_motor, rf_motor)


def mecanum_drivetrain(
    lr_motor: float,
    rr_motor: float,
    lf_motor: float,
    rf_motor: float,
    x_wheelbase: float | Quantity[Any] = 2,
    y_wheelbase: float | Quantity[Any] = 3,
    speed: float | Quantity[Any] = 5,
    deadzone: DeadzoneCallable | None = None,
) -> DriveVector:
    """Return the result of :class:`MecanumDrivetrain`'s `get_vector`. Deprecated since 2018.2.0: use that class."""
    _deprecated("mecanum_drivetrain", "MecanumDrivetrain")
    drivetrain = MecanumDrivetrain(x_wheelbase, y_wheelbase, speed, deadzone)
    return drivetrain.get_vector(lr_motor, rr_motor, lf_motor, rf_motor)


def _deprecated(function: str, replacement: str) -> None:
    message = f"{function} is deprecated: create a {replacement} once, and call its get_vector"
    warnings.warn(message, DeprecationWarning, stacklevel=3)
