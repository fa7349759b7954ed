"""Connects your physics module with the simulated robot."""

from pyfrc_core.physics.core import PhysicsEngine, PhysicsInitException, PhysicsInterface

__all__ = ["PhysicsEngine", "PhysicsInitException", "PhysicsInterface"]
