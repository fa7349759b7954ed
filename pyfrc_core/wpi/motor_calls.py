"""The calls with which robot code sets motors: what the seasons' `motor_controllers` report. It imports no WPILib."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from typing import Any

#: Called with the motor controller or drive, the function's name, its numeric arguments, and whether they are powers
#: from -1 to 1.
OnMotorCall = Callable[[Any, str, tuple[float, ...], bool], None]


class MotorCalls:
    """The calls of one run.

    Attributes:
        listener: called with each call, before it has an effect
        members: weak references to the motors of each group and drive that was created, by its id: objects of WPILib's
            are not hashable in all versions, and opmodes may make new ones of the same channels
    """

    def __init__(self) -> None:
        self.listener: OnMotorCall = lambda motor, name, numbers, is_power: None
        self.members: dict[int, list[weakref.ref[Any]]] = {}


def with_derived(base: type[object]) -> Iterator[type[Any]]:
    """Return a class and all that are derived from it."""
    yield base
    subclasses: list[type[Any]] = base.__subclasses__()
    for derived in subclasses:
        yield from with_derived(derived)


def of_drive(real: Callable[..., object], name: str, calls: MotorCalls) -> Callable[..., Any]:
    """Return a drive's function that reports its call."""

    def drive(self: object, *args: object, **kwargs: object) -> Any:
        calls.listener(self, name, numbers_in(args, kwargs), False)
        return real(self, *args, **kwargs)

    return drive


def noting_members(
    real: Callable[..., None], members: dict[int, list[weakref.ref[Any]]], motor: type[Any]
) -> Callable[..., None]:
    """Return the constructor of a group or drive that notes its motors.

    :param motor: the class of motor controllers
    """

    def __init__(self: object, *args: object, **kwargs: object) -> None:
        real(self, *args, **kwargs)
        members[id(self)] = [weakref.ref(each) for each in (*args, *kwargs.values()) if isinstance(each, motor)]

    return __init__


def numbers_in(args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[float, ...]:
    """Return the numbers among the arguments of a call."""
    if len(args) == 1 and type(args[0]) is float and not kwargs:  # nearly always
        return args
    return tuple(
        each for each in (*args, *kwargs.values()) if isinstance(each, float | int) and not isinstance(each, bool)
    )
