"""The same objects as in `pyfrc_core.sim.user_renderer`."""

from pyfrc_core.sim.user_renderer import UserRenderer

__all__ = ["UserRenderer"]
