"""Intercept the calls with which robot code sets its motors.

The calls are intercepted in Python, since WPILib passes 0 for NaN, and 1 for greater values.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any

import wpilib
from wpilib.interfaces import MotorController

from ...hal import HalData
from ...runtime.patch_table import Patch
from ..prepared_patches import PreparedPatches

#: Called with the motor controller or drive, the function's name, its numeric arguments, and whether they are powers
#: from -1 to 1.
OnMotorCall = Callable[[Any, str, tuple[float, ...], bool], None]


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


def motor_groups() -> tuple[type[Any], ...]:
    """Return the classes that are made of other motors, and set them without a call in Python."""
    return (wpilib.MotorControllerGroup, *(drive for drive, _ in _drives()))


class MotorCalls:
    """The calls of one run.

    Attributes:
        listener: called with each call, before it has an effect
        members: the motors of each group and drive that was created, by its id: objects of WPILib's are not hashable
            in all versions
    """

    def __init__(self) -> None:
        self.listener: OnMotorCall = lambda motor, name, numbers, is_power: None
        self.members: dict[int, list[Any]] = {}


def watch_motor_calls() -> AbstractContextManager[MotorCalls]:
    """Watch until the context ends; the robot's modules must be imported."""
    return _watches.watching(MotorCalls)


def prepare_motor_watch(prepare: bool = True) -> None:
    """Prepare `watch_motor_calls` for the forks of this process, or undo that; the robot's modules must be imported."""
    if prepare:
        _watches.prepare(MotorCalls())
    else:
        _watches.undo()


def _patches(calls: MotorCalls) -> Iterator[Patch]:
    for owner in _with_derived(MotorController):
        for name, wrap in (("set", _set), ("setVoltage", _set_voltage)):
            if name in vars(owner):
                yield Patch(owner, name, wrap(vars(owner)[name], calls))
    for drive, names in _drives():
        for name in names:
            yield Patch(drive, name, _drive(vars(drive)[name], name, calls))
    for group in motor_groups():
        yield Patch(group, "__init__", _init(group.__init__, calls.members))


_watches = PreparedPatches(_patches)


def _with_derived(base: type[object]) -> Iterator[type[Any]]:
    yield base
    subclasses: list[type[Any]] = base.__subclasses__()
    for derived in subclasses:
        yield from _with_derived(derived)


# Each wrapper must have the name of the function it wraps: WPILib's bindings take a call from a function of the same
# name for a call of `super()`, as it is where a robot's own class overrides the method.


def _set(real: Callable[..., object], calls: MotorCalls) -> Callable[..., Any]:
    def set(self: object, *args: object, **kwargs: object) -> Any:
        calls.listener(self, "set", _numbers(args, kwargs), True)
        return real(self, *args, **kwargs)

    return set


def _set_voltage(real: Callable[..., object], calls: MotorCalls) -> Callable[..., Any]:
    def setVoltage(self: object, *args: object, **kwargs: object) -> Any:
        calls.listener(self, "setVoltage", _numbers(args, kwargs), False)
        return real(self, *args, **kwargs)

    return setVoltage


def _drive(real: Callable[..., object], name: str, calls: MotorCalls) -> Callable[..., Any]:
    def drive(self: object, *args: object, **kwargs: object) -> Any:
        calls.listener(self, name, _numbers(args, kwargs), False)
        return real(self, *args, **kwargs)

    return drive


def _init(real: Callable[..., None], members: dict[int, list[Any]]) -> Callable[..., None]:
    def __init__(self: object, *args: object, **kwargs: object) -> None:
        real(self, *args, **kwargs)
        members[id(self)] = [each for each in (*args, *kwargs.values()) if isinstance(each, MotorController)]

    return __init__


def _numbers(args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[float, ...]:
    if len(args) == 1 and type(args[0]) is float and not kwargs:  # nearly always
        return args
    return tuple(
        each for each in (*args, *kwargs.values()) if isinstance(each, float | int) and not isinstance(each, bool)
    )


class InertMotors:
    """Recognizes motor controllers that ignore what they receive while the robot is disabled: those on the CAN bus, and
    groups and drives of them. WPILib's own are PWM outputs, which keep the value for the moment of enabling.

    :param members: see `MotorCalls`
    """

    def __init__(self, hal_data: HalData, members: Mapping[int, Sequence[Any]]) -> None:
        self._hal_data = hal_data
        self._members = members

    def is_inert(self, motor: object) -> bool:
        """Return whether a motor controller or drive is inert while the robot is disabled.

        A class of the robot's own is: it passes its calls on to another motor controller.
        """
        if isinstance(motor, motor_groups()):
            members = self._members.get(id(motor))
            if members is None:  # created before it could be watched
                return not any(output["initialized"] for output in self._hal_data["pwm"])
            return all(self.is_inert(member) for member in members)
        return not isinstance(motor, wpilib.PWMMotorController)

    def in_group(self, motor: object) -> bool:
        """Return whether a motor belongs to a drive or a group."""
        return any(motor is member for members in self._members.values() for member in members)
