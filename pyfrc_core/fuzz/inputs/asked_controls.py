"""Watch which controls of its joysticks robot code asks for: drivers press what has a function.

The HAL knows only that a joystick is read. So the functions that read are intercepted in Python. The triggers of the
command framework call them, too.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import cache
from typing import Any, NamedTuple

import wpilib
from wpilib.interfaces import GenericHID

from ...runtime.patch_table import Patch
from ..prepared_patches import PreparedPatches

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


class AskedControls:
    """The controls that robot code has asked for, as targets of scripts, in the order of the first time."""

    def __init__(self) -> None:
        self.targets: dict[str, None] = {}

    def wrap(self, real: Callable[..., Any], reads: _Reads) -> Callable[..., Any]:
        """Return a method that notes what it reads, and calls the real one."""
        note = self._note
        calls: set[tuple[int, tuple[Any, ...]]] = set()  # noted before

        def ask(self: Any, *args: Any, **kwargs: Any) -> Any:
            call = id(self), args
            if call not in calls:
                calls.add(call)
                note(self.getPort(), reads(self, *args, *kwargs.values()))
            return real(self, *args, **kwargs)

        return ask

    def wrap_static(self, real: Callable[..., object], kind: str) -> Any:
        """Return a function of the driver station that notes what it reads, and calls the real one."""

        def ask(stick: int, number: int) -> Any:
            self._note(stick, (kind, number))
            return real(stick, number)

        return staticmethod(ask)

    def _note(self, port: int, control: tuple[str, int]) -> None:
        kind, number = control
        self.targets[f"joysticks[{port}].{kind}[{number}]"] = None


def watch_controls() -> AbstractContextManager[AskedControls]:
    """Watch until the context ends."""
    return _watches.watching(AskedControls)


def prepare_control_watch(prepare: bool = True) -> None:
    """Prepare `watch_controls` for the forks of this process, or undo that."""
    if prepare:
        _watches.prepare(AskedControls())
    else:
        _watches.undo()


class _Reading(NamedTuple):
    """A function that reads a control.

    :param reads: returns what it reads; for functions of the driver station, the key in `hal_data`
    """

    owner: Any
    name: str
    real: Callable[..., Any]
    reads: _Reads | str


def _patches(asked: AskedControls) -> Iterator[Patch]:
    for owner, name, real, reads in _reading_functions():
        wrapped = asked.wrap_static(real, reads) if isinstance(reads, str) else asked.wrap(real, reads)
        yield Patch(owner, name, wrapped)


_watches = PreparedPatches(_patches)


@cache
def _reading_functions() -> list[_Reading]:
    return list(_find_reading_functions())


def _find_reading_functions() -> Iterator[_Reading]:
    for name, kind in _BY_NUMBER.items():
        yield _Reading(GenericHID, name, vars(GenericHID)[name], _numbered(kind))
    for name, function in vars(GenericHID).items():
        if re.match(r"POV\w", name):
            yield _Reading(GenericHID, name, function, _always("povs", 0))
    for name, kind in _OF_DRIVER_STATION.items():
        yield _Reading(wpilib.DriverStation, name, getattr(wpilib.DriverStation, name), kind)
    for owner in _GAMEPADS:
        for name, reads in _named(owner):
            yield _Reading(owner, name, vars(owner)[name], reads)
    for name, real in vars(wpilib.Joystick).items():
        if (axis := _AXIS.match(name)) is not None:
            yield _Reading(wpilib.Joystick, name, real, _channel(f"get{axis[1]}Channel"))
        elif (button := _NAME.match(name)) is not None and button[1].lower() in ("trigger", "top"):
            number = 1 if button[1].lower() == "trigger" else 2
            yield _Reading(wpilib.Joystick, name, real, _always("buttons", number))


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
