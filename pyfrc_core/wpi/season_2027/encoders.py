"""Quadrature encoders, and how physics turns them."""

from __future__ import annotations

from wpilib import Encoder
from wpilib.simulation import EncoderSim

__all__ = ["Encoder", "EncoderSim", "add_counts", "distance_per_count", "set_rate", "simulation_of"]


def simulation_of(encoder: Encoder | EncoderSim) -> EncoderSim:
    """Return the simulation of an encoder."""
    return encoder if isinstance(encoder, EncoderSim) else EncoderSim(encoder)


def distance_per_count(encoder: EncoderSim) -> float:
    """Return the distance that one count is, as the robot has set it."""
    return encoder.get_distance_per_pulse()


def add_counts(encoder: EncoderSim, counts: int) -> None:
    """Let the encoder count further, from what the robot has set it to."""
    encoder.set_count(encoder.get_count() + counts)


def set_rate(encoder: EncoderSim, rate: float) -> None:
    """Set the distance per second that the robot reads."""
    encoder.set_rate(rate)
