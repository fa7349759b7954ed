"""The IMU in SystemCore, in `hal_data`, from when robot code makes an `OnboardIMU`: the HAL does not report that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from weakref import WeakSet

from ...wpi.season_2027 import imu


class _Watch:
    """A function to call when robot code makes an `OnboardIMU`. It is called as long as this object is kept."""

    def __init__(self, call: Callable[..., object]) -> None:
        self.call = call


_made: WeakSet[Any] = WeakSet()
_watches: WeakSet[_Watch] = WeakSet()


def note(made: object, *_: object, **__: object) -> None:
    """Note an `OnboardIMU` that robot code has made."""
    _made.add(made)
    for watch in list(_watches):
        watch.call()


class ImuSim:
    """The IMU, with functions as WPILib's classes for other simulated devices have them."""

    def __init__(self) -> None:
        for value in imu.VALUES:
            setattr(self, f"get_{value}", imu.reader(value))
            setattr(self, f"set_{value}", imu.writer(value))

    def get_active(self) -> bool:
        """Return whether robot code has one."""
        return len(_made) > 0

    def register_active_callback(self, callback: Callable[..., object], notify: bool) -> object:
        """Call a function when it does, as long as the result is kept."""
        watch = _Watch(callback)
        _watches.add(watch)
        return watch
