"""Joysticks as teams have them: how many axes, buttons and POVs each model has, and its name."""

from __future__ import annotations

import random
from dataclasses import dataclass

from .values import Value

#: How often a port has one of these models in place of a joystick with the most common controls.
_SHARE = 0.3
#: The ports of drivers.
_PORTS = 2


@dataclass(frozen=True)
class JoystickModel:
    """A joystick: its controls, and how it describes itself."""

    name: str
    axes: int
    buttons: int
    povs: int
    is_xbox: bool = False

    def writes(self, port: int) -> dict[str, Value]:
        """Return what plugs it in at a port that has a joystick."""
        stick = f"joysticks[{port}]"
        return {
            f"{stick}.axis_count": self.axes,
            f"{stick}.button_count": self.buttons,
            f"{stick}.pov_count": self.povs,
            f"{stick}.name": self.name,
            f"{stick}.is_xbox": self.is_xbox,
        }


MODELS = (
    JoystickModel("Controller (XBOX 360 For Windows)", 6, 10, 1, is_xbox=True),
    JoystickModel("Wireless Controller", 6, 14, 1),
    JoystickModel("Logitech Extreme 3D", 4, 12, 1),
    JoystickModel("Logitech Attack 3", 3, 11, 0),
    JoystickModel("Generic USB Joystick", 2, 12, 0),
    JoystickModel("Button box", 5, 32, 0),
)


def choose_models(rng: random.Random) -> dict[int, JoystickModel]:
    """Return the ports that have another model than usual."""
    return {port: rng.choice(MODELS) for port in range(_PORTS) if rng.random() < _SHARE}
