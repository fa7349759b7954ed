"""The IMU in SystemCore: WPILib's simulation only writes its values; an `OnboardIMU` of our own reads them."""

from __future__ import annotations

from collections.abc import Callable

from wpilib import OnboardIMU
from wpilib.simulation import OnboardIMUSim

#: The names of its values: radians, radians per second, and metres per second squared.
VALUES = (
    "yaw",
    *(f"{what}_{axis}" for what in ("angle", "gyro_rate", "accel") for axis in "xyz"),
)

#: Made here, since pyfrc notes those that are made later as the robot's. Its yaw is never reset, and so the HAL's own.
_READER = OnboardIMU(OnboardIMU.MountOrientation.FLAT)


def reader(value: str) -> Callable[[], float]:
    """Return the function that reads one of `VALUES`."""
    read: Callable[[], float] = getattr(_READER, f"get_{value}")
    return read


def writer(value: str) -> Callable[[float], None]:
    """Return the function that writes one of `VALUES`."""
    write: Callable[[float], None] = getattr(OnboardIMUSim(), f"set_{value}")
    return write
