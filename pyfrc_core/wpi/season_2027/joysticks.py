"""Joysticks as robot code has them: their classes, and which control each of their functions reads."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any, TypeGuard

import wpilib
from wpilib import GenericHID

__all__ = ["RIGHT_STICK_FORWARD", "TRIGGERS", "GenericHID", "class_of", "is_joystick", "port_of", "replacements"]

#: Called with a port, a key of the joystick in `hal_data`, and the number of a control that robot code asks for.
OnAsk = Callable[[int, str, int], object]

#: Returns the key in `hal_data` and the number of the control that a call with these arguments reads.
_Reads = Callable[..., "tuple[str, int]"]

_BY_NUMBER = {
    "get_raw_button": "buttons",
    "get_raw_button_pressed": "buttons",
    "get_raw_button_released": "buttons",
    "button": "buttons",
    "get_raw_axis": "axes",
    "axis_greater_than": "axes",
    "axis_less_than": "axes",
    "get_pov": "povs",
}
_OF_DRIVER_STATION = {
    "get_stick_button": "buttons",
    "get_stick_button_pressed": "buttons",
    "get_stick_button_released": "buttons",
    "get_stick_axis": "axes",
    "get_stick_pov": "povs",
}
_NAME = re.compile(r"(?:get_)?(\w+?)(?:_button)?(?:_pressed|_released)?$")

#: WPILib's classes of gamepads: each has enumerations of its buttons and axes.
_GAMEPADS: tuple[Any, ...] = tuple(
    each
    for each in vars(wpilib).values()
    if isinstance(each, type) and hasattr(each, "Button") and hasattr(each, "Axis")
)


def _numbers(enumeration: object) -> dict[str, int]:
    """Return the numbers of an enumeration of controls, by name in lower case: ``left_bumper``."""
    names = [name for name in vars(enumeration) if name.isupper()]
    return {name.lower(): int(getattr(enumeration, name)) for name in names}


def _triggers(owner: Any) -> tuple[int, ...]:
    """Return the axes of a gamepad that are triggers."""
    axes = _numbers(owner.Axis)
    return tuple(axes[name] for name in axes if re.search(r"trigger|^[lr]2$", name))


#: The axes of gamepads for their right stick forward and backward: the driver station's own, and those of 2026.
RIGHT_STICK_FORWARD = (3, 5)

#: The trigger axes of gamepads, by class: their values go from 0 to 1, not from -1.
TRIGGERS: dict[str, tuple[int, ...]] = {each.__name__: _triggers(each) for each in _GAMEPADS}

_TYPES = GenericHID.HIDType
#: Joysticks that teams have: name, numbers of axes, buttons and POVs, whether it is a gamepad, and of which type. The
#: buttons and axes of a gamepad are those of `wpilib.Gamepad`, on every make; its POV is four of the buttons.
MODELS = (
    ("Xbox 360 Controller", 6, 15, 0, True, int(_TYPES.XBOX_360)),
    ("Xbox One Controller", 6, 16, 0, True, int(_TYPES.XBOX_ONE)),
    ("PS4 Controller", 6, 21, 0, True, int(_TYPES.PS4)),
    ("Nintendo Switch Pro Controller", 6, 16, 0, True, int(_TYPES.SWITCH_PRO)),
    ("Logitech Extreme 3D", 4, 12, 1, False, int(_TYPES.UNKNOWN)),
    ("Logitech Attack 3", 3, 11, 0, False, int(_TYPES.UNKNOWN)),
    ("Button box", 5, 32, 0, False, int(_TYPES.UNKNOWN)),
)


def is_joystick(thing: object) -> TypeGuard[wpilib.HIDDevice]:
    """Return whether this is a joystick or a gamepad."""
    return isinstance(thing, wpilib.HIDDevice)


def port_of(stick: wpilib.HIDDevice) -> int:
    """Return where a joystick is plugged in."""
    return stick.get_hid().get_port()


def class_of(stick: wpilib.HIDDevice) -> str:
    """Return the name of WPILib's class of a joystick, from which a team may have derived its own."""
    return next((each.__name__ for each in type(stick).__mro__ if hasattr(wpilib, each.__name__)), "")


def replacements(on_ask: OnAsk) -> Iterator[tuple[Any, str, Any]]:
    """Return the functions that read a control, with their owner and name: each reports what it reads.

    The triggers of the command framework call them, too.
    """
    for owner, name, real, reads in _reading_functions():
        yield owner, name, _asking(real, reads, on_ask)
    for name, real, kind in _station_functions():
        yield wpilib.DriverStationBackend, name, _asking_station(real, kind, on_ask)


def _asking(real: Callable[..., Any], reads: _Reads, on_ask: OnAsk) -> Callable[..., Any]:
    calls: set[tuple[int, tuple[Any, ...]]] = set()  # reported before

    def ask(self: Any, *args: Any, **kwargs: Any) -> Any:
        call = id(self), args
        if call not in calls:
            calls.add(call)
            on_ask(port_of(self), *reads(self, *args, *kwargs.values()))
        return real(self, *args, **kwargs)

    return ask


def _asking_station(real: Callable[..., object], kind: str, on_ask: OnAsk) -> Any:
    def ask(stick: int, number: int) -> Any:
        on_ask(stick, kind, number)
        return real(stick, number)

    return staticmethod(ask)


@cache
def _station_functions() -> list[tuple[str, Callable[..., Any], str]]:
    station = wpilib.DriverStationBackend
    return [(name, getattr(station, name), kind) for name, kind in _OF_DRIVER_STATION.items()]


@cache
def _reading_functions() -> list[tuple[Any, str, Callable[..., Any], _Reads]]:
    return [(owner, name, vars(owner)[name], reads) for owner, name, reads in _find_reading_functions()]


def _find_reading_functions() -> Iterator[tuple[Any, str, _Reads]]:
    for name, kind in _BY_NUMBER.items():
        yield wpilib.GenericHID, name, _numbered(kind)
        if name in vars(wpilib.Joystick):
            yield wpilib.Joystick, name, _numbered(kind)
    for name in vars(wpilib.GenericHID):
        if re.match(r"pov_\w", name):
            yield wpilib.GenericHID, name, _always("povs", 0)
    for owner in _GAMEPADS:
        for name, reads in _named(owner):
            yield owner, name, reads
    for name, channel in _JOYSTICK_AXES.items():
        yield wpilib.Joystick, name, _channel(channel)
    for name in vars(wpilib.Joystick):
        button = _NAME.match(name)
        if button is not None and button[1] in _JOYSTICK_BUTTONS:
            yield wpilib.Joystick, name, _always("buttons", _JOYSTICK_BUTTONS[button[1]])


#: The functions of a joystick that read an axis, and those that return its number.
_JOYSTICK_AXES = {f"get_{axis}": f"get_{axis}_channel" for axis in ("x", "y", "z", "twist", "throttle")}
_JOYSTICK_BUTTONS = {
    "trigger": int(wpilib.Joystick.ButtonType.TRIGGER_BUTTON),
    "top": int(wpilib.Joystick.ButtonType.TOP_BUTTON),
}


def _named(owner: Any) -> Iterator[tuple[str, _Reads]]:
    """Return a gamepad's functions that read one control, such as ``get_left_bumper_button_pressed``."""
    buttons, axes = _numbers(owner.Button), _numbers(owner.Axis)
    for name in vars(owner):
        found = _NAME.match(name)
        if found is None or name.startswith("_"):
            continue
        axis, button = axes.get(found[1]), buttons.get(found[1])
        if button is not None:
            yield name, _always("buttons", button)
        elif axis is not None:
            yield name, _always("axes", axis)


def _numbered(kind: str) -> _Reads:
    return lambda stick, number=0, *_: (kind, number)


def _always(kind: str, number: int) -> _Reads:
    return lambda *_: (kind, number)


def _channel(name: str) -> _Reads:
    return lambda stick: ("axes", getattr(stick, name)())
