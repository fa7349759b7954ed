"""The six joysticks as the window has them: what was set here, or is told of the robot's. Without a window."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .devices import Values

if TYPE_CHECKING:
    from ....config.sim import SimConfig
    from ...engine.simulation import Simulation

JOYSTICKS = 6
#: So many axes are shown; more of them where they have labels.
_AXES, BUTTONS = 6, 12

_AXIS_NAMES = ("X", "Y", "Z", "Throttle")

#: Nobody touches the POV.
RELEASED = -1


@dataclass
class Stick:
    """One joystick's controls. Buttons count from 1: the first of the list is none."""

    axes: list[float] = field(default_factory=lambda: [0.0] * 12)
    buttons: list[bool] = field(default_factory=lambda: [False] * 33)
    pov: int = RELEASED
    plugged: bool = True


class Sticks:
    """What the six joysticks' controls are at; moves them."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self.sticks = [Stick() for _ in range(JOYSTICKS)]
        self._told: list[Any] = [None] * JOYSTICKS

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

    def plug(self, stick: int, plugged_in: bool) -> None:
        """Plug a joystick in, or pull it out."""
        self.sticks[stick].plugged = plugged_in
        self._simulation.plug(stick, plugged_in)

    def adopt(self, values: Values) -> None:
        """Take over what the robot's joysticks have become, by a script or after going back in time."""
        for number, stick in enumerate(self.sticks):
            room = f"joysticks[{number}]"
            told = tuple(values.get(f"{room}.{part}") for part in ("axes", "buttons", "povs"))
            if told == self._told[number]:
                continue
            self._told[number] = told
            axes, buttons, povs = told
            stick.plugged = axes is not None
            stick.axes[: len(axes or ())] = axes or ()
            stick.buttons[: len(buttons or ())] = buttons or ()
            stick.pov = int(povs[0]) if povs else RELEASED


def axis_labels(config: SimConfig, stick: int) -> dict[int, str]:
    """The axes that are shown, and what is written beside them."""
    named = dict(config.joysticks[stick].axes) if stick in config.joysticks else {}
    shown = sorted({*range(_AXES), *named})
    return {axis: named.get(axis) or _axis_name(axis) for axis in shown}


def _axis_name(axis: int) -> str:
    return f"{axis} {_AXIS_NAMES[axis]}" if axis < len(_AXIS_NAMES) else str(axis)


def button_labels(config: SimConfig, stick: int) -> dict[int, str]:
    """What is written beside the buttons that have a name."""
    named = dict(config.joysticks[stick].buttons) if stick in config.joysticks else {}
    return {1: "Trigger", 2: "Top"} | named


def direction(x: float, y: float) -> int:
    """Which of a POV's eight directions a point is in, seen from the middle, y downwards: degrees clockwise from up."""
    return round(math.degrees(math.atan2(x, -y)) / 45) % 8 * 45
