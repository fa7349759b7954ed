"""Robot time, along the bottom: run, pause, step, and the speed. The page has a timeline to go back, too."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from ...engine.simulation import Simulation
from ...engine.snapshot import Snapshot, Status
from ..models.time_controls import SPEEDS, toggle
from ..models.wording import clock, speed_text
from .boxes import tame
from .theme import Theme
from .tooltip import Tooltip


class TimeBar:
    """The controls of time.

    :param done: called when the user has chosen a speed, so that keys drive again
    """

    def __init__(
        self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation, done: Callable[[], None]
    ) -> None:
        px = theme.px
        self._simulation, self._done = simulation, done
        self._shown: object = None
        self.frame = frame = ttk.Frame(parent)
        self.run = ttk.Button(frame, text="Pause", width=7, command=lambda: toggle(simulation), takefocus=False)
        self.run.pack(side="left")
        tooltip.attach(self.run, "Pause robot time, or go on: F5")
        self.step = ttk.Button(frame, text="Step", width=5, command=simulation.step, takefocus=False)
        self.step.pack(side="left", padx=(px(4), px(14)))
        tooltip.attach(self.step, "Let one packet pass, 0.02 s, and pause: F6")
        ttk.Label(frame, text="Speed", style="Muted.TLabel").pack(side="left")
        texts = [speed_text(speed) for speed in SPEEDS]
        self.speed = ttk.Combobox(frame, values=texts, state="readonly", width=6, font=theme.body, takefocus=False)
        self.speed.bind("<<ComboboxSelected>>", lambda event: self._choose_speed())
        tame(self.speed, done)
        self.speed.pack(side="left", padx=(px(6), px(14)))
        tooltip.attach(self.speed, "Robot seconds per second; max: as fast as possible")
        self._time = ttk.Label(frame, font=theme.bold, width=8, anchor="e")
        self._time.pack(side="left")
        self.restart = ttk.Button(frame, text="Restart", command=simulation.restart, takefocus=False)
        self.restart.pack(side="right")
        tooltip.attach(self.restart, "Start the robot program again, at time 0: F9")

    def show(self, snapshot: Snapshot | None, status: Status) -> None:
        """Show the moment, and the speed of time."""
        time = clock(0.0 if snapshot is None else snapshot.time)
        if time != self._time.cget("text"):
            self._time.configure(text=time)
        state = status.state, status.speed
        if state == self._shown:
            return
        self._shown = state
        going = status.state == "running"
        self.run.configure(
            text="Pause" if going else "Run", style="Accent.TButton" if status.state == "paused" else "TButton"
        )
        self.run.state(["!disabled" if status.state in ("running", "paused") else "disabled"])
        self.step.state(["!disabled" if status.state in ("running", "paused") else "disabled"])
        self.speed.set(speed_text(status.speed))

    def _choose_speed(self) -> None:
        self._simulation.set_speed(SPEEDS[self.speed.current()])
        self._done()
