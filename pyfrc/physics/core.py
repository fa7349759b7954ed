"""The interface between your physics module and the simulated robot."""

from pyfrc_core.physics.core import PhysicsEngine, PhysicsInitException, PhysicsInterface

__all__ = ["PhysicsEngine", "PhysicsInitException", "PhysicsInterface"]
