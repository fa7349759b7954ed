"""Helpers for encoders."""

from pyfrc_core.physics.encoders import EncoderShaft

__all__ = ["EncoderShaft"]
