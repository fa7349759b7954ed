"""A simulation session: `Simulation`, what it shows, and what front ends are made of."""

from .engine.options import SimOptions
from .engine.scene import Field, Scene
from .engine.simulation import Simulation
from .engine.snapshot import Failure, Snapshot, Status
from .ui import FrontEnd

__all__ = ["Failure", "Field", "FrontEnd", "Scene", "SimOptions", "Simulation", "Snapshot", "Status"]
