"""Robot code's own physics: `_simulationPeriodic` of a robot, and `simulationPeriodic` of its subsystems.

They see outputs as ``physics.py`` does: those of a robot that is disabled are off.
"""

from __future__ import annotations

import sys
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING

from ...compat.wpilib_private import SIMULATION_PERIODIC, simulation_periodic_of
from ...wpi import commands, station

if TYPE_CHECKING:
    from ...hal.output_gate import OutputGate


def gate_robot(robot: object, gate: Callable[[], OutputGate]) -> None:
    """Have the robot's `_simulationPeriodic` see the outputs of a disabled robot as off.

    :param gate: returns what turns the outputs off
    """
    if simulation_periodic_of(robot) is not None:
        setattr(robot, SIMULATION_PERIODIC.name, _gated(robot, SIMULATION_PERIODIC.name, gate))


def gate_subsystems(gate: Callable[[], OutputGate]) -> None:
    """Do the same for the subsystems that exist when `robotInit` is over."""
    commands2 = sys.modules.get("commands2")
    if commands2 is None:
        return
    for subsystem in commands.registered_subsystems():
        if type(subsystem).simulationPeriodic is not commands2.Subsystem.simulationPeriodic:
            subsystem.simulationPeriodic = _gated(subsystem, "simulationPeriodic", gate)


def _gated(owner: object, name: str, gate: Callable[[], OutputGate]) -> Callable[[], None]:
    reference = weakref.ref(owner)  # or it would hold on to itself

    def simulate() -> None:
        __tracebackhide__ = True
        owner = reference()
        if station.is_enabled():
            getattr(type(owner), name)(owner)
        else:
            with gate().closed_while_disabled():
                getattr(type(owner), name)(owner)

    return simulate
