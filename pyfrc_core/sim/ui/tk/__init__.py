"""The simulator's own window, made with tkinter: the field, the robot's devices, a driver station, robot time."""

from __future__ import annotations

import gc

from ...engine.simulation import Simulation
from .. import FrontEnd
from .window import Window


class TkFrontEnd(FrontEnd):
    """Shows a simulation in a window until it is closed."""

    def __init__(self) -> None:
        self._window: Window | None = None

    def run(self, simulation: Simulation) -> int:
        try:
            self._show(simulation)
        finally:
            # Tk objects that another thread destroyed would wait for an event loop that is over.
            gc.collect()
            simulation.close()
        return 0

    def saved(self, files: list[str]) -> None:
        """Show that the robot gets new code."""
        if (window := self._window) is not None:
            window.announce(f"saved: {', '.join(files)}")

    def _show(self, simulation: Simulation) -> None:
        self._window = window = Window(simulation)
        try:
            simulation.start()
            window.loop()
        finally:
            self._window = None
            window.close()
