"""A simulation session: `Simulation`, what it shows, and what front ends are made of."""

from .options import SimOptions
from .scene import Field, Scene
from .simulation import Simulation
from .snapshot import Failure, Snapshot, Status
from .ui import FrontEnd

__all__ = ["Failure", "Field", "FrontEnd", "Scene", "SimOptions", "Simulation", "Snapshot", "Status"]
