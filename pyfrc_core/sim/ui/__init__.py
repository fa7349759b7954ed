"""Front ends: each shows a simulation and lets a person drive it. One module or package for each."""

from __future__ import annotations

from abc import ABC, abstractmethod

from ..engine.simulation import Simulation


class FrontEnd(ABC):
    """Shows one simulation.

    A front end reads `Simulation.snapshot` and `Simulation.status` when it draws, reads output and changes by its
    own cursors, and calls the simulation's methods for its user. Several front ends can show one simulation.
    `pyfrc_core.sim.ui.choose` has the table of front ends.
    """

    @abstractmethod
    def run(self, simulation: Simulation) -> int:
        """Start the simulation, and show it until the user closes it or it is over.

        :returns: the command's exit code
        """

    def saved(self, files: list[str]) -> None:  # noqa: B027 - optional
        """Show that these files were saved and that the robot gets their code. --watch calls it on another thread."""
