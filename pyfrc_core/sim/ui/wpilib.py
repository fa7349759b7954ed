"""WPILib's own simulator window, of `robotpy-halsim-gui`: it lives in the robot's process, and draws the HAL itself."""

from __future__ import annotations

import sys

from ..engine.simulation import Simulation
from . import FrontEnd


class WpilibWindow(FrontEnd):
    """Waits for the user to close that window; the simulation has loaded it."""

    def run(self, simulation: Simulation) -> int:
        """The exit code is 1 when the robot has failed."""
        with simulation:
            while not simulation.wait_for(lambda: simulation.status.state in ("failed", "closed"), timeout=0.25):
                self._print(simulation)
            failure = simulation.status.failure
        self._print(simulation)
        if failure is None:
            return 0
        sys.stdout.write(f"failed at {failure.time:.2f} s: {failure.headline}\n")
        return failure.exit_code

    @staticmethod
    def _print(simulation: Simulation) -> None:
        sys.stdout.write(simulation.take_output())
        sys.stdout.flush()
