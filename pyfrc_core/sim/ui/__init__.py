"""Front ends: what shows a simulation and lets a person take part in it. One module for each."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..engine.simulation import Simulation


class FrontEnd(ABC):
    """Shows one simulation.

    A front end asks `Simulation.snapshot` and `Simulation.status` when it wants to draw, and calls the simulation's
    methods for what its user wants. It need know nothing else.
    """

    @abstractmethod
    def run(self, simulation: Simulation) -> int:
        """Show the simulation, which has not been started, until the user closes it or it is over.

        :returns: the command's exit code
        """

    def saved(self, files: list[str]) -> None:  # noqa: B027 - who shows nothing of it need not listen
        """These files were saved, and the robot gets their code: with --watch, from another thread."""
