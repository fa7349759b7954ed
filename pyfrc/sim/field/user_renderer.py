"""The same objects as in `pyfrc_core.sim.engine.robot_side.user_renderer`."""

from pyfrc_core.sim.engine.robot_side.user_renderer import UserRenderer

__all__ = ["UserRenderer"]
