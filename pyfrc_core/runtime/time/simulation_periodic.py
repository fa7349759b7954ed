"""Robot code's own physics: `_simulationPeriodic` of a robot, and `simulationPeriodic` of its subsystems.

They see outputs as ``physics.py`` does: those of a robot that is disabled are off. The scheduler calls those of
subsystems before the commands, so what they write to sensors is there for these.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable

from ...hal.output_gate import OutputGate
from ...wpi import commands, robots, station


def gate_robot(robot: object, gate: Callable[[], OutputGate], after: Callable[[], object]) -> None:
    """Have the robot's `_simulationPeriodic` see the outputs of a disabled robot as off.

    :param gate: returns what turns the outputs off
    :param after: called when it has returned
    """
    if (name := robots.own_simulation(robot)) is not None:
        setattr(robot, name, _gated(robot, name, gate, after))


def gate_subsystems(gate: Callable[[], OutputGate], after: Callable[[], object]) -> None:
    """Do the same for the subsystems that exist when `robotInit` is over."""
    for subsystem, name in commands.simulated_subsystems():
        setattr(subsystem, name, _gated(subsystem, name, gate, after))


def _gated(owner: object, name: str, gate: Callable[[], OutputGate], after: Callable[[], object]) -> Callable[[], None]:
    reference = weakref.ref(owner)  # or it would hold on to itself

    def simulate() -> None:
        __tracebackhide__ = True
        owner = reference()
        if station.is_enabled():
            getattr(type(owner), name)(owner)
        else:
            with gate().closed_while_disabled():
                getattr(type(owner), name)(owner)
        after()

    return simulate
