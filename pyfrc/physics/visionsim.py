"""Simulate a camera that detects targets: what it sees, and when the robot receives the data."""

from pyfrc_core.physics.visionsim import VisionSim, VisionSimTarget

__all__ = ["VisionSim", "VisionSimTarget"]
