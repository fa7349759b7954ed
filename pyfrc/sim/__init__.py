"""What robot code may ask of the simulator while it runs in one."""

from pyfrc_core.sim.engine.robot_side.user_renderer import get_user_renderer

__all__ = ["get_user_renderer"]
