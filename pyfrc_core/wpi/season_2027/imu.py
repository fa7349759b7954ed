"""The IMU in SystemCore: WPILib's simulation of it writes its values, and its C interface reads them, too."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import c_double
from typing import Any

from wpilib.simulation import OnboardIMUSim

from .encoders import NATIVE_HAL

#: The names of its values in the HAL: radians, radians per second, and metres per second squared.
VALUES = {
    "yaw": "Yaw",
    **{f"angle_{axis}": f"Angle{axis.upper()}" for axis in "xyz"},
    **{f"gyro_rate_{axis}": f"GyroRate{axis.upper()}" for axis in "xyz"},
    **{f"accel_{axis}": f"Accel{axis.upper()}" for axis in "xyz"},
}


def reader(value: str) -> Callable[[], float]:
    """Return the function that reads one of `VALUES`."""
    read: Any = getattr(NATIVE_HAL.find(), f"HALSIM_GetIMU{VALUES[value]}")
    read.restype = c_double
    return lambda: float(read())


def writer(value: str) -> Callable[[float], None]:
    """Return the function that writes one of `VALUES`."""
    write: Callable[[float], None] = getattr(OnboardIMUSim(), f"set_{value}")
    return write
