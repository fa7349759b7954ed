"""Motors: their data, from which physics computes how they move."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from wpimath import DCMotor

__all__ = ["DCMotor", "MotorData", "data_of", "usual_motor", "with_gears"]


class MotorData(NamedTuple):
    """The data of one or several motors together, in SI units.

    :param kv: speed per voltage, in rad/s per V
    :param kt: torque per current, in N m per A
    :param resistance: in ohms
    """

    kv: float
    kt: float
    resistance: float


def data_of(motor: DCMotor) -> MotorData:
    """Return the data of a motor."""
    return MotorData(motor.kv, motor.kt, motor.r)


def with_gears(motor: DCMotor, gearing: float) -> DCMotor:
    """Return the motor with gears; `gearing` is how often it turns for one turn behind them."""
    return motor.with_reduction(gearing)


#: The usual motor on each motor controller of a vendor's, by the controller's class.
_USUAL: dict[str, Callable[[int], DCMotor]] = {
    "SparkMax": DCMotor.neo,
    "SparkFlex": DCMotor.neo_vortex,
    "TalonFX": DCMotor.kraken_x60,
}


def usual_motor(controller: str) -> tuple[str, Callable[[int], DCMotor]]:
    """Return the usual motor on a vendor's controller: its name in `DCMotor`, and the function for so many of them."""
    make = _USUAL[controller]
    return make.__name__, make
