"""WPILib's own simulator window, of `robotpy-halsim-gui`: it runs in the robot's process, and draws the HAL itself."""

from __future__ import annotations

import sys

from ..engine.output_log import OutputCursor
from ..engine.simulation import Simulation
from . import FrontEnd


class WpilibWindow(FrontEnd):
    """Waits for the user to close that window, which the robot's process has opened."""

    def run(self, simulation: Simulation) -> int:
        """Run the simulation, and return the exit code: 1 when the robot has failed."""
        output = simulation.output_cursor()
        with simulation:
            while not simulation.wait_for(lambda: simulation.status.state in ("failed", "closed"), timeout=0.25):
                self._print(output)
            failure = simulation.status.failure
        self._print(output)
        if failure is None:
            return 0
        sys.stdout.write(f"failed at {failure.time:.2f} s: {failure.headline}\n")
        return failure.exit_code

    @staticmethod
    def _print(output: OutputCursor) -> None:
        sys.stdout.write(output.read())
        sys.stdout.flush()
