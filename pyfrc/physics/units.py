"""The units that physical quantities are given in: ``5 * units.feet``."""

from pyfrc_core.physics.units import units

__all__ = ["units"]
