"""What a front end's controls of robot time do: run and pause, the speed slider, the timeline."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...engine.simulation import Simulation

#: The slowest and the fastest speed on the slider; beyond the fastest comes "as fast as possible".
SLOWEST, FASTEST = 0.1, 8.0
#: Where on the slider, from 0 to 1, "as fast as possible" begins.
_UNLIMITED = 0.94
_PACKET_SECONDS = 0.02


def toggle(simulation: Simulation) -> None:
    """Pause, or go on."""
    if simulation.wants_to_run:
        simulation.pause()
    else:
        simulation.resume()


def rewind(simulation: Simulation, seconds: float) -> None:
    """Go back to the packet that is nearest to a moment on the timeline."""
    simulation.rewind(round(seconds / _PACKET_SECONDS) * _PACKET_SECONDS)


def slider_of_speed(speed: float) -> float:
    """Return the slider's position for a speed, from 0 to 1; each doubling takes the same distance."""
    if speed == 0:
        return 1.0
    speed = min(max(speed, SLOWEST), FASTEST)
    return _UNLIMITED * math.log(speed / SLOWEST) / math.log(FASTEST / SLOWEST)


def speed_of_slider(position: float) -> float:
    """Return the speed at a position of the slider, rounded; near real time, it is real time."""
    if position >= (1 + _UNLIMITED) / 2:
        return 0.0
    exact: float = SLOWEST * (FASTEST / SLOWEST) ** (min(max(position, 0.0), _UNLIMITED) / _UNLIMITED)
    if 0.93 < exact < 1.07:
        return 1.0
    return round(exact, 2) if exact < 1 else round(exact, 1)
