"""A simulation session: `Simulation`, what it shows, and what front ends are made of.

In: a project, options, and commands of a person or a program. Out: an immutable `Snapshot` after each report of the
robot, a `Status`, all changes and all output, and a recording. `engine` is the session, `ui` has the front ends. The
engine calls none of them: each reads what it shows, so that several can show one simulation, and a robot that crashes
or hangs takes no window with it.
"""

from .engine.options import SimOptions
from .engine.scene import Field, Scene
from .engine.simulation import Simulation
from .engine.snapshot import Failure, Snapshot, Status
from .ui import FrontEnd

__all__ = ["Failure", "Field", "FrontEnd", "Scene", "SimOptions", "Simulation", "Snapshot", "Status"]
