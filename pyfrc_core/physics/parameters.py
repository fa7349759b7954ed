"""Checks of the physics helpers' parameters, with errors that name the parameter."""

from __future__ import annotations

import math
import numbers

from ..errors import PyfrcError


class ParameterError(PyfrcError, ValueError, AssertionError):
    """A parameter of a physics helper has an impossible value; an `AssertionError` as in 2019."""


class WrongDimension(PyfrcError, ValueError):
    """A parameter has a unit of another dimension, such as a mass in feet, or lacks a required unit."""


def finite(value: object, parameter: str) -> float:
    """Return `value` as a float if it is a finite number.

    :raises ParameterError: otherwise, with the parameter and the value
    """
    if isinstance(value, numbers.Real) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    if hasattr(value, "units"):
        raise ParameterError(f"{parameter} = {value}: must be a plain number, without a unit")
    raise ParameterError(f"{parameter} = {value!r}: must be a finite number")


def positive(value: object, parameter: str) -> float:
    """Return `value` as a float if it is a finite number above zero.

    :raises ParameterError: otherwise, with the parameter and the value
    """
    number = finite(value, parameter)
    if number > 0:
        return number
    raise ParameterError(f"{parameter} = {value!r}: must be above zero")


def not_negative(value: object, parameter: str) -> float:
    """Return `value` as a float if it is zero or a finite number above zero.

    :raises ParameterError: otherwise, with the parameter and the value
    """
    number = finite(value, parameter)
    if number >= 0:
        return number
    raise ParameterError(f"{parameter} = {value!r}: must not be below zero")


def within_full_power(motor_value: float, parameter: str) -> float:
    """Limit `motor_value` to the range from -1 to 1, since no motor can give more than full power.

    :raises ParameterError: when it is not a number, or NaN, which would remain in the robot's position forever
    """
    try:
        if -1.0 <= motor_value <= 1.0:
            return motor_value
    except TypeError:
        raise ParameterError(f"{parameter} = {motor_value!r}: must be a number between -1 and 1") from None
    if motor_value != motor_value:
        raise ParameterError(f"{parameter} is not a number (NaN)", remedy="a motor's value is between -1 and 1")
    return math.copysign(1.0, motor_value)
