"""Quadrature encoders: their channels, and how physics turns them."""

from __future__ import annotations

from wpilib import Encoder
from wpilib.simulation import EncoderSim

from ...compat.private_name import IncompatibleLibraryError, PrivateName

__all__ = ["Encoder", "EncoderSim", "add_counts", "channels_of", "distance_per_count", "set_rate", "simulation_of"]

NATIVE_HAL = PrivateName(
    "native.wpihal._init_robotpy_native_wpihal:__lib",
    "hal_data shows the channels of an encoder by it",
)


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


def channels_of(index: int) -> tuple[int, int] | None:
    """Return the two digital channels of an encoder of the simulated HAL; None where the HAL does not say.

    :param index: of an encoder that is initialized
    """
    # The HAL's C interface has them, its Python interface has not. Its library is loaded already.
    try:
        library = NATIVE_HAL.find()
        a, b = library.HALSIM_GetEncoderDigitalChannelA, library.HALSIM_GetEncoderDigitalChannelB
    except (IncompatibleLibraryError, AttributeError):
        return None
    return int(a(index)), int(b(index))
