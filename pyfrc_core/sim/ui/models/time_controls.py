"""What a front end's controls of robot time do: run and pause, the speed, the timeline."""

from __future__ import annotations

from ...engine.simulation import Simulation

#: The slowest and the fastest speed of a slider; beyond the fastest comes "as fast as possible".
SLOWEST, FASTEST = 0.1, 8.0
#: The speeds of a list; 0: as fast as possible.
SPEEDS = (SLOWEST, 0.25, 0.5, 1.0, 2.0, 4.0, FASTEST, 0.0)
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
