"""A model of a tank drive, from its motors' values to how far the robot moves."""

from pyfrc_core.physics.tankmodel import MotorModel, TankModel

__all__ = ["MotorModel", "TankModel"]
