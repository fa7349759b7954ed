"""Encoders that physics turns: the robot may reset them at any time, and reads their rate."""

from __future__ import annotations

from ..wpi import encoders
from .parameters import finite


class EncoderShaft:
    """A shaft that turns a quadrature encoder.

    `EncoderSim.setDistance` sets the distance that the robot reads, so after the robot's ``reset()`` the next call
    brings the former distance back. Like a real encoder, this one continues to count from the robot's ``reset()``. It
    also sets the rate, without which `wpilib.Encoder.getRate` returns nearly 0.

    :param encoder: the robot's encoder, or its simulation
    :param units: what the encoder measures while the position grows by 1, such as 0.3048 if positions are in feet and
        the robot has called ``setDistancePerPulse`` for metres
    :raises ParameterError: when `units` is not a finite number
    """

    def __init__(self, encoder: encoders.Encoder | encoders.EncoderSim, units: float = 1.0) -> None:
        self._encoder = encoders.simulation_of(encoder)
        self._units = finite(units, "units")
        self._counts = 0

    def turn_to(self, position: float, velocity: float) -> None:
        """Turn the encoder to a position, measured from where it was at the start.

        :param position: in any unit; `units` converts it to the encoder's
        :param velocity: per second
        :raises ParameterError: when one of them is not a finite number
        """
        distance = finite(position, "position") * self._units
        counts = round(distance / encoders.distance_per_count(self._encoder))
        if counts != self._counts:
            encoders.add_counts(self._encoder, counts - self._counts)
            self._counts = counts
        encoders.set_rate(self._encoder, finite(velocity, "velocity") * self._units)
