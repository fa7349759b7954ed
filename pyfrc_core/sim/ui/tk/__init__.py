"""The simulator's own window, made with tkinter: the field, the robot's devices, a driver station, robot time."""

from __future__ import annotations

import gc
from typing import TYPE_CHECKING

from .. import FrontEnd
from .window import Window

if TYPE_CHECKING:
    from ...simulation import Simulation


class TkFrontEnd(FrontEnd):
    """Shows a simulation in a window until it is closed."""

    def run(self, simulation: Simulation) -> int:
        try:
            self._show(simulation)
        finally:
            # What is Tk's must not be left for another thread to tidy away: it would wait for a loop that is over.
            gc.collect()
            simulation.close()
        return 0

    @staticmethod
    def _show(simulation: Simulation) -> None:
        window = Window(simulation)
        try:
            simulation.start()
            window.loop()
        finally:
            window.close()
