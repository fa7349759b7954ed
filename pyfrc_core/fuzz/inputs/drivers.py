"""Drivers: how they use their controls (what they press together, hold, tap, press once more), and which joysticks
teams have.

The numbers of a habit are drawn from its tuples, so that a number that is there twice is twice as likely.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from ...wpi import joysticks, station
from .values import Value


@dataclass(frozen=True)
class Habit:
    """One way to use the controls for a while.

    :param weight: how often drivers do it, relative to the other habits
    :param let_go: the share of the held controls that are released before
    :param seconds: the shortest and the longest duration
    :param buttons: how many buttons are pressed and held
    :param axes: how many axes are moved
    :param pov: the share in which a POV is pressed
    :param taps: how many buttons are tapped
    :param times: how often each of them is tapped
    :param together: whether all drivers do it at the same time
    """

    weight: int
    let_go: float
    seconds: tuple[float, float]
    buttons: tuple[int, ...]
    axes: tuple[int, ...]
    pov: float
    taps: tuple[int, ...] = (0,)
    times: tuple[int, ...] = (1,)
    together: bool = False

    def duration(self, rng: random.Random) -> float:
        """Return a duration in seconds, evenly over the orders of magnitude."""
        low, high = self.seconds
        return math.exp(rng.uniform(math.log(low), math.log(high)))


#: Several controls at once, then others.
_POSE = Habit(50, 0.75, (0.04, 2), (0, 0, 1, 1, 2, 2, 2, 3, 3, 4), (0, 0, 1, 1, 1, 2, 2, 2, 4), 0.35, (0, 0, 1, 2))
#: Many controls at once: what the robot has several conditions for.
_CHORD = Habit(8, 0.5, (0.1, 1.5), (2, 3, 3, 4), (1, 1, 2), 0.7)
#: One more control, while the others are held.
_ONE_MORE = Habit(14, 0.1, (0.06, 1), (0, 1, 1, 1), (0, 0, 1), 0.15)
#: A button that is held for seconds, while others are tapped.
_HOLD = Habit(14, 0.6, (2, 6), (1, 1, 2), (0, 0, 1), 0.25, (0, 1, 2), (1, 2, 3))
#: Double taps, and toggles.
_TAPS = Habit(14, 0.3, (0.3, 1.5), (0, 0, 1), (0,), 0.1, (1, 1, 2), (2, 2, 3, 4))
#: All drivers at the same time.
_TOGETHER = Habit(12, 0.75, (0.1, 2), (1, 1, 2, 2, 3), (0, 1, 2), 0.3, (0, 1), together=True)

_HABITS = (_POSE, _CHORD, _ONE_MORE, _HOLD, _TAPS, _TOGETHER)
_WEIGHTS = [habit.weight for habit in _HABITS]


def draw_habit(rng: random.Random) -> Habit:
    """Return a random habit."""
    (habit,) = rng.choices(_HABITS, _WEIGHTS)
    return habit


# -- joysticks -------------------------------------------------------------------------------------------------------

#: How often a port has one of these models in place of a joystick with the most common controls.
_SHARE = 0.3
#: The ports of drivers.
_PORTS = 2


@dataclass(frozen=True)
class JoystickModel:
    """A joystick: its controls, and how it describes itself.

    :param type: the number of the gamepad's type; None where a driver station sends none
    """

    name: str
    axes: int
    buttons: int
    povs: int
    is_gamepad: bool = False
    type: int | None = None

    def writes(self, port: int) -> dict[str, Value]:
        """Return what plugs it in at a port that has a joystick."""
        stick = f"joysticks[{port}]"
        return {
            f"{stick}.axis_count": self.axes,
            f"{stick}.button_count": self.buttons,
            f"{stick}.pov_count": self.povs,
            f"{stick}.name": self.name,
            f"{stick}.{station.GAMEPAD_FLAG}": self.is_gamepad,
            **({} if self.type is None else {f"{stick}.type": self.type}),
        }


MODELS = tuple(JoystickModel(*each) for each in joysticks.MODELS)


def choose_models(rng: random.Random) -> dict[int, JoystickModel]:
    """Return the ports that have another model than usual."""
    return {port: rng.choice(MODELS) for port in range(_PORTS) if rng.random() < _SHARE}
