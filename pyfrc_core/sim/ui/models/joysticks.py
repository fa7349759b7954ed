"""The state of the six joysticks: set by the user, or taken over from the robot's."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ....project import Project
from ....project.walk import python_files
from ....season import CURRENT
from .devices import Values

if TYPE_CHECKING:
    from ....config.sim import SimConfig
    from ...engine.simulation import Simulation

JOYSTICKS = 6
#: The number of axes and buttons that are shown; labelled axes are shown, too.
_AXES, BUTTONS = 6, 12
#: The number of the first button, and of how many buttons a person can press.
FIRST_BUTTON, MOST_BUTTONS = CURRENT.first_button, 32

_AXIS_NAMES = ("X", "Y", "Z", "Throttle")

#: WPILib's names of a flight stick's buttons, and what is written on those of an Xbox controller.
_FLIGHT_STICK = {FIRST_BUTTON: "Trigger", FIRST_BUTTON + 1: "Top"}
_XBOX_NAMES = {
    "a": "A",
    "b": "B",
    "x": "X",
    "y": "Y",
    "left_bumper": "LB",
    "right_bumper": "RB",
    "back": "Back",
    "start": "Start",
    "left_stick": "LS",
    "right_stick": "RS",
}
_XBOX = {
    number: _XBOX_NAMES[name]
    for number, name in enumerate(CURRENT.gamepad.buttons, FIRST_BUTTON)
    if name in _XBOX_NAMES
}
_CLASSES = re.compile(r"\b(?:Command)?(XboxController|PS[45]Controller|StadiaController|GenericHID|Joystick|Gamepad)\(")

#: The angle of a POV that is not pressed.
RELEASED = -1


@dataclass
class Stick:
    """One joystick's controls. Where buttons count from 1, the first entry of their list is unused."""

    axes: list[float] = field(default_factory=lambda: [0.0] * 12)
    buttons: list[bool] = field(default_factory=lambda: [False] * (FIRST_BUTTON + MOST_BUTTONS))
    pov: int = RELEASED
    plugged: bool = True


class Joysticks:
    """The state of the six joysticks' controls, and the methods that move them."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self.sticks = [Stick() for _ in range(JOYSTICKS)]
        self._adopted: list[Any] = [None] * JOYSTICKS

    def move(self, stick: int, axis: int, value: float) -> None:
        """Move an axis."""
        self.sticks[stick].axes[axis] = value
        self._simulation.set_axis(stick, axis, value)

    def press(self, stick: int, button: int, pressed: bool) -> None:
        """Press or release a button."""
        self.sticks[stick].buttons[button] = pressed
        self._simulation.set_button(stick, button, pressed)

    def turn(self, stick: int, angle: int) -> None:
        """Press the POV in a direction, or release it."""
        if angle != self.sticks[stick].pov:
            self.sticks[stick].pov = angle
            self._simulation.set_pov(stick, 0, angle)

    def adopt(self, values: Values) -> None:
        """Take over the robot's joysticks, which a script or going back in time has changed."""
        for number, stick in enumerate(self.sticks):
            path = f"joysticks[{number}]"
            state = tuple(values.get(f"{path}.{part}") for part in ("axes", "buttons", "povs"))
            if state == self._adopted[number]:
                continue
            self._adopted[number] = state
            axes, buttons, povs = state
            stick.plugged = axes is not None
            stick.axes[: len(axes or ())] = axes or ()
            stick.buttons[: len(buttons or ())] = buttons or ()
            stick.pov = int(povs[0]) if povs else RELEASED


def axis_labels(config: SimConfig, stick: int) -> dict[int, str]:
    """Return the labels of the axes that are shown."""
    named = dict(config.joysticks[stick].axes) if stick in config.joysticks else {}
    shown = sorted({*range(_AXES), *named})
    return {axis: named.get(axis) or _axis_name(axis) for axis in shown}


def _axis_name(axis: int) -> str:
    return f"{axis} {_AXIS_NAMES[axis]}" if axis < len(_AXIS_NAMES) else str(axis)


def joystick_classes(project: Project) -> frozenset[str]:
    """Return the classes of joysticks that a project's code names where it creates them; none without a program."""
    if not project.main_file.is_file():  # of a log
        return frozenset()
    texts = (file.read_text("utf-8", "replace") for file in python_files(project.root))
    return frozenset(name for text in texts for name in _CLASSES.findall(text))


def button_labels(config: SimConfig, stick: int, classes: frozenset[str]) -> dict[int, str]:
    """Return the labels of the buttons that have one.

    :param classes: those of the joysticks in the project's code; of several, it is not known which one this is
    """
    named = dict(config.joysticks[stick].buttons) if stick in config.joysticks else {}
    if classes == {"Joystick"}:
        return _FLIGHT_STICK | named
    named = {number: label for number, label in named.items() if _FLIGHT_STICK.get(number) != label}
    return (_XBOX if classes == {"XboxController"} else {}) | named


def direction(x: float, y: float) -> int:
    """Return a POV's angle for a point beside its middle, y downwards: one of eight, in degrees clockwise from up."""
    return round(math.degrees(math.atan2(x, -y)) / 45) % 8 * 45
