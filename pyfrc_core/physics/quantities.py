"""Convert physical quantities of users, with or without a unit, to the plain numbers of our calculations.

Each is converted once, when it is passed: all later calculations are with plain numbers. pint is imported only when the
user passes a quantity.
"""

from __future__ import annotations

import numbers
import sys
from typing import TYPE_CHECKING

from .parameters import WrongDimension as WrongDimension
from .parameters import finite
from .units import units

if TYPE_CHECKING:
    from .units import Quantity

#: The name of each dimension in errors, a unit of that dimension, and an example.
KINDS = (
    ("a length", "foot", "2 * units.feet"),
    ("a mass", "pound", "90 * units.lbs"),
    ("a time", "second", "5 * units.ms"),
    ("a speed", "foot / second", "12 * units.fps"),
    ("an acceleration", "foot / second ** 2", "10 * units.feet / units.second ** 2"),
    ("a voltage", "volt", "1.3 * units.volt"),
    ("a current", "ampere", "40 * units.ampere"),
    ("a torque", "newton * meter", "2.42 * units.N_m"),
    ("a speed of rotation", "1 / second", "5310 * units.cpm"),
    ("a moment of inertia", "pound * foot ** 2", "110 * units.lbs * units.feet ** 2"),
    ("a voltage for a speed", "volt * second / foot", "0.92 * units.tm_kv"),
    ("a voltage for an acceleration", "volt * second ** 2 / foot", "0.22 * units.tm_ka"),
    ("a number without a dimension", "dimensionless", "0.5"),
)


def magnitude(value: float | Quantity | object, unit: str, parameter: str, *, plain: bool = False) -> float:
    """Return `value` as a number of `unit`. A quantity may belong to any pint registry, which converts it.

    :param unit: the unit of the result, such as ``"foot"``, as pint spells it; not one of pyfrc's own units
    :param parameter: the parameter's name, for the error
    :param plain: whether a number without a unit is allowed; it is then in `unit` already
    :raises WrongDimension: with the parameter, its value, and an example
    :raises ParameterError: when it is not a finite number
    """
    is_number = isinstance(value, numbers.Real) and not isinstance(value, bool)
    if plain and is_number:
        return finite(value, parameter)
    pint = sys.modules.get("pint")  # a quantity exists only after its import
    if pint is not None and isinstance(value, pint.Quantity):
        try:
            converted = value.to(unit).magnitude
        except pint.DimensionalityError:
            raise _wrong(f"{value} is {_kind(value.dimensionality)}", unit, parameter) from None
        return finite(converted, parameter)
    if is_number:
        raise _wrong(f"{value!r} has no unit", unit, parameter)
    if pint is not None and isinstance(value, pint.Unit):
        raise _wrong(f"{value} is a unit without a number", unit, parameter)
    raise _wrong(f"{value!r} is not a quantity", unit, parameter)


def _wrong(given: str, unit: str, parameter: str) -> WrongDimension:
    from .dimensionality import WrongUnit

    dimensionality = units.parse_units(unit).dimensionality
    examples = (text for _, each, text in KINDS if units.parse_units(each).dimensionality == dimensionality)
    expected = f"{_kind(dimensionality)} was expected, such as {next(examples, f'2 {unit}')}"
    return WrongUnit(given, unit, f"{given}, {expected}", where=parameter)


def _kind(dimensionality: object) -> str:
    """Return the name of a dimension, such as ``a length``, or pint's own description."""
    names = (name for name, unit, _ in KINDS if units.parse_units(unit).dimensionality == dimensionality)
    return next(names, f"of dimension {dimensionality}")
