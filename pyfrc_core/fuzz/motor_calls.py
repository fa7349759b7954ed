"""Intercept the calls with which robot code sets its motors.

The calls are intercepted in Python, since WPILib passes 0 for NaN, and 1 for greater values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import wpilib
import wpilib.drive
import wpilib.interfaces

from ..runtime.patch_table import Patch, patched

#: Called with the motor controller or drive, the function's name, its numeric arguments, and whether they are powers
#: from -1 to 1.
OnMotorCall = Callable[[Any, str, tuple[float, ...], bool], None]

#: The class of each drive, and its functions that set its motors.
DRIVES = (
    (wpilib.drive.DifferentialDrive, ("arcadeDrive", "curvatureDrive", "tankDrive")),
    (wpilib.drive.MecanumDrive, ("driveCartesian", "drivePolar")),
)


@contextmanager
def intercept_motor_calls(on_motor_call: OnMotorCall) -> Iterator[None]:
    """Report every call to `on_motor_call` until the context ends; the robot's modules must be imported."""
    with patched(_patches(on_motor_call)):
        yield


def _patches(on_motor_call: OnMotorCall) -> Iterator[Patch]:
    for owner in _with_derived(wpilib.interfaces.MotorController):
        for name, wrap in (("set", _set), ("setVoltage", _set_voltage)):
            if name in vars(owner):
                yield Patch(owner, name, wrap(vars(owner)[name], on_motor_call))
    for drive, names in DRIVES:
        for name in names:
            yield Patch(drive, name, _drive(vars(drive)[name], name, on_motor_call))


def _with_derived(base: type[object]) -> Iterator[type[Any]]:
    yield base
    subclasses: list[type[Any]] = base.__subclasses__()
    for derived in subclasses:
        yield from _with_derived(derived)


# Each wrapper must have the name of the function it wraps: WPILib's bindings take a call from a function of the same
# name for a call of `super()`, as it is where a robot's own class overrides the method.


def _set(real: Callable[..., object], on_motor_call: OnMotorCall) -> Callable[..., Any]:
    def set(self: object, *args: object, **kwargs: object) -> Any:
        on_motor_call(self, "set", _numbers(args, kwargs), True)
        return real(self, *args, **kwargs)

    return set


def _set_voltage(real: Callable[..., object], on_motor_call: OnMotorCall) -> Callable[..., Any]:
    def setVoltage(self: object, *args: object, **kwargs: object) -> Any:
        on_motor_call(self, "setVoltage", _numbers(args, kwargs), False)
        return real(self, *args, **kwargs)

    return setVoltage


def _drive(real: Callable[..., object], name: str, on_motor_call: OnMotorCall) -> Callable[..., Any]:
    def drive(self: object, *args: object, **kwargs: object) -> Any:
        on_motor_call(self, name, _numbers(args, kwargs), False)
        return real(self, *args, **kwargs)

    return drive


def _numbers(args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[float, ...]:
    if len(args) == 1 and type(args[0]) is float and not kwargs:  # nearly always
        return args
    return tuple(
        each for each in (*args, *kwargs.values()) if isinstance(each, float | int) and not isinstance(each, bool)
    )
