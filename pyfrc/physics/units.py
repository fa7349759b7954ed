"""The units of physical quantities: ``5 * units.feet``."""

from pyfrc_core.physics.units import Helpers, units

__all__ = ["Helpers", "units"]
