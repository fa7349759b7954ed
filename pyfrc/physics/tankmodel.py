"""A model of a tank drive: compute the robot's motion from its motors' values."""

from pyfrc_core.physics.tankmodel import MotorModel, TankModel

__all__ = ["MotorModel", "TankModel"]
