"""Joysticks as robot code has them: their classes, and which control each of their functions reads."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, TypeGuard

import wpilib
from wpilib.interfaces import GenericHID

__all__ = ["RIGHT_STICK_FORWARD", "TRIGGERS", "GenericHID", "class_of", "is_joystick", "port_of", "replacements"]

#: The axes of gamepads for their right stick forward and backward.
RIGHT_STICK_FORWARD = (5,)

#: The trigger axes of gamepads, by class: their values go from 0 to 1, not from -1.
TRIGGERS: dict[str, tuple[int, ...]] = {"XboxController": (2, 3), "PS4Controller": (3, 4), "PS5Controller": (3, 4)}

#: Called with a port, a key of the joystick in `hal_data`, and the number of a control that robot code asks for.
OnAsk = Callable[[int, str, int], object]

#: Returns the key in `hal_data` and the number of the control that a call with these arguments reads.
_Reads = Callable[..., "tuple[str, int]"]

_BY_NUMBER = {
    "getRawButton": "buttons",
    "getRawButtonPressed": "buttons",
    "getRawButtonReleased": "buttons",
    "button": "buttons",
    "getRawAxis": "axes",
    "axisGreaterThan": "axes",
    "axisLessThan": "axes",
    "getPOV": "povs",
}
_OF_DRIVER_STATION = {
    "getStickButton": "buttons",
    "getStickButtonPressed": "buttons",
    "getStickButtonReleased": "buttons",
    "getStickAxis": "axes",
    "getStickPOV": "povs",
}
_GAMEPADS = (wpilib.XboxController, wpilib.PS4Controller, wpilib.PS5Controller, wpilib.StadiaController)
_AXIS = re.compile(r"get(X|Y|Z|Twist|Throttle)$")
_NAME = re.compile(r"(?:get)?(\w+?)(?:Button)?(?:Pressed|Released)?$")

#: Joysticks that teams have: name, numbers of axes, buttons and POVs, and whether the driver station says "XBox".
MODELS = (
    ("Controller (XBOX 360 For Windows)", 6, 10, 1, True),
    ("Wireless Controller", 6, 14, 1, False),
    ("Logitech Extreme 3D", 4, 12, 1, False),
    ("Logitech Attack 3", 3, 11, 0, False),
    ("Generic USB Joystick", 2, 12, 0, False),
    ("Button box", 5, 32, 0, False),
)


def is_joystick(thing: object) -> TypeGuard[GenericHID]:
    """Return whether this is a joystick or a gamepad."""
    return isinstance(thing, GenericHID)


def port_of(stick: GenericHID) -> int:
    """Return where a joystick is plugged in."""
    return stick.getPort()


def class_of(stick: GenericHID) -> str:
    """Return the name of WPILib's class of a joystick, from which a team may have derived its own."""
    return next((each.__name__ for each in type(stick).__mro__ if hasattr(wpilib, each.__name__)), "")


def replacements(on_ask: OnAsk) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that read a control, with their owner and name: each reports what it reads.

    The triggers of the command framework call them, too.
    """
    for owner, name, real, reads in _reading_functions():
        yield owner, name, _asking(real, reads, on_ask)
    for name, real, kind in _station_functions():
        yield wpilib.DriverStation, name, _asking_station(real, kind, on_ask)


def _asking(real: Callable[..., Any], reads: _Reads, on_ask: OnAsk) -> Callable[..., Any]:
    calls: set[tuple[int, tuple[Any, ...]]] = set()  # reported before

    def ask(self: Any, *args: Any, **kwargs: Any) -> Any:
        call = id(self), args
        if call not in calls:
            calls.add(call)
            on_ask(self.getPort(), *reads(self, *args, *kwargs.values()))
        return real(self, *args, **kwargs)

    return ask


def _asking_station(real: Callable[..., object], kind: str, on_ask: OnAsk) -> Any:
    def ask(stick: int, number: int) -> Any:
        on_ask(stick, kind, number)
        return real(stick, number)

    return staticmethod(ask)


@cache
def _station_functions() -> list[tuple[str, Callable[..., Any], str]]:
    station = wpilib.DriverStation
    return [(name, getattr(station, name), kind) for name, kind in _OF_DRIVER_STATION.items()]


@cache
def _reading_functions() -> list[tuple[Any, str, Callable[..., Any], _Reads]]:
    return [(owner, name, vars(owner)[name], reads) for owner, name, reads in _find_reading_functions()]


def _find_reading_functions() -> Iterator[tuple[Any, str, _Reads]]:
    for name, kind in _BY_NUMBER.items():
        yield GenericHID, name, _numbered(kind)
    for name in vars(GenericHID):
        if re.match(r"POV\w", name):
            yield GenericHID, name, _always("povs", 0)
    for owner in _GAMEPADS:
        for name, reads in _named(owner):
            yield owner, name, reads
    for name in vars(wpilib.Joystick):
        if (axis := _AXIS.match(name)) is not None:
            yield wpilib.Joystick, name, _channel(f"get{axis[1]}Channel")
        elif (button := _NAME.match(name)) is not None and button[1].lower() in ("trigger", "top"):
            yield wpilib.Joystick, name, _always("buttons", 1 if button[1].lower() == "trigger" else 2)


def _named(owner: Any) -> Iterator[tuple[str, _Reads]]:
    """Return a gamepad's functions that read one control, such as ``getLeftBumperPressed`` and ``leftBumper``."""
    buttons, axes = _numbers(owner.Button), _numbers(owner.Axis)
    for name in vars(owner):
        found = _NAME.match(name)
        if found is None or name.startswith("_"):
            continue
        axis, button = axes.get(found[1].removesuffix("Axis").lower()), buttons.get(found[1].lower())
        if button is not None and (axis is None or "Axis" not in name):
            yield name, _always("buttons", button)
        elif axis is not None:
            yield name, _always("axes", axis)


def _numbers(enumeration: object) -> dict[str, int]:
    """Return the numbers of an enumeration of controls, by name in lower case: "leftbumper" for ``kLeftBumper``."""
    names = [name for name in vars(enumeration) if re.match("k[A-Z]", name)]
    return {name[1:].lower(): int(getattr(enumeration, name)) for name in names}


def _numbered(kind: str) -> _Reads:
    return lambda stick, number=0, *_: (kind, number)


def _always(kind: str, number: int) -> _Reads:
    return lambda *_: (kind, number)


def _channel(name: str) -> _Reads:
    return lambda stick: ("axes", getattr(stick, name)())
