"""Helpers for mechanisms that move along a line."""

from pyfrc_core.physics.motion import LinearMotion

__all__ = ["LinearMotion"]
