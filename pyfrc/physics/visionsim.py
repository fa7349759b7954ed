"""What a camera that looks for targets would see, and when the robot would hear of it."""

from pyfrc_core.physics.visionsim import VisionSim, VisionSimTarget

__all__ = ["VisionSim", "VisionSimTarget"]
