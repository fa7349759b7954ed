"""The units of physical quantities: ``5 * units.feet``."""

from pyfrc_core.physics.units import units

__all__ = ["units"]
