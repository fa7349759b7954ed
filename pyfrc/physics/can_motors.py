"""Motors on REV's and CTRE's motor controllers, with their gears, load and sensors, and swerve drives of them."""

from pyfrc_core.physics.can_motors import Controller, Mechanism, Spark, Talon
from pyfrc_core.physics.swerve import SwerveDrive, SwerveModule

__all__ = ["Controller", "Mechanism", "Spark", "SwerveDrive", "SwerveModule", "Talon"]
