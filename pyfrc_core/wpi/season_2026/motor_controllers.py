"""Motor controllers: of which kind an object is, and the calls with which robot code sets it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any

import wpilib
from wpilib.interfaces import MotorController

from ..motor_calls import MotorCalls as MotorCalls
from ..motor_calls import OnMotorCall as OnMotorCall
from ..motor_calls import noting_members, numbers_in, of_drive, with_derived

#: The packages of WPILib's own motor controllers.
_WPILIBS = ("wpilib",)


def is_inverted(thing: object) -> bool:
    """Return whether the robot has inverted a motor controller; False for other objects."""
    return isinstance(thing, MotorController) and thing.getInverted()


def is_pwm(thing: object) -> bool:
    """Return whether this is a motor controller that a PWM output sets, which moves only by what robot code sets."""
    return isinstance(thing, wpilib.PWMMotorController)


def power_of(motor: MotorController) -> float:
    """Return the power that is set, from -1 to 1."""
    return motor.get()


#: The name of the function that returns the power of a motor controller.
POWER_GETTER = "get"


def with_own_getter() -> list[type[Any]]:
    """Return the classes with their own `POWER_GETTER`, if there are any besides WPILib's: those for PWM read the HAL.

    REV's ``SparkMax`` is an example; a team's own motor controller class may be another.
    """
    own = [
        each
        for each in with_derived(MotorController)
        if each.__module__.partition(".")[0] not in _WPILIBS and callable(vars(each).get(POWER_GETTER))
    ]
    return [*dict.fromkeys(own), wpilib.MotorControllerGroup] if own else []


def is_group(thing: object) -> bool:
    """Return whether this is made of other motors, and sets them without a call in Python."""
    return isinstance(thing, _groups())


def _groups() -> tuple[type[Any], ...]:
    return (wpilib.MotorControllerGroup, *(drive for drive, _ in _drives()))


def _drives() -> list[tuple[type[Any], tuple[str, ...]]]:
    """Return the class of each drive, and its functions that set its motors.

    Empty unless the robot imports wpilib.drive: an import here would hide that the robot forgot it.
    """
    drive = sys.modules.get("wpilib.drive")
    if drive is None:
        return []
    return [
        (drive.DifferentialDrive, ("arcadeDrive", "curvatureDrive", "tankDrive")),
        (drive.MecanumDrive, ("driveCartesian", "drivePolar")),
    ]


# -- the calls that set motors -----------------------------------------------------------------------------------------


def replacements(calls: MotorCalls) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that set motors, with their owner and name: each reports its call.

    They are replaced in Python, since WPILib passes 0 for NaN, and 1 for greater values.
    """
    for owner in with_derived(MotorController):
        for name, wrap in (("set", _set), ("setVoltage", _set_voltage)):
            if name in vars(owner):
                yield owner, name, wrap(vars(owner)[name], calls)
    for drive, names in _drives():
        for name in names:
            yield drive, name, of_drive(vars(drive)[name], name, calls)
    for group in _groups():
        yield group, "__init__", noting_members(group.__init__, calls.members, MotorController)


# Each wrapper must have the name of the function it wraps: WPILib's bindings take a call from a function of the same
# name for a call of `super()`, as it is where a robot's own class overrides the method.


def _set(real: Callable[..., object], calls: MotorCalls) -> Callable[..., Any]:
    def set(self: object, *args: object, **kwargs: object) -> Any:
        calls.listener(self, "set", numbers_in(args, kwargs), True)
        return real(self, *args, **kwargs)

    return set


def _set_voltage(real: Callable[..., object], calls: MotorCalls) -> Callable[..., Any]:
    def setVoltage(self: object, *args: object, **kwargs: object) -> Any:
        calls.listener(self, "setVoltage", numbers_in(args, kwargs), False)
        return real(self, *args, **kwargs)

    return setVoltage
