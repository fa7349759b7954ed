"""Robot time, along the bottom: run, pause, step, speed, and the timeline to go back."""

from __future__ import annotations

import tkinter as tk
from pathlib import Path
from tkinter import filedialog, ttk
from typing import TYPE_CHECKING

from ....errors import PyfrcError
from ...engine.snapshot import Snapshot, Status
from ..models.time_controls import rewind, slider_of_speed, speed_of_slider, toggle
from ..models.wording import clock, speed_text
from .slider import Slider
from .theme import Theme
from .tooltip import Tooltip

if TYPE_CHECKING:
    from ...engine.simulation import Simulation


class TimeBar:
    """The controls of time, and the timeline of the recording."""

    def __init__(self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation) -> None:
        px = theme.px
        self._simulation = simulation
        #: The result of saving, for the user.
        self.note = ""
        self._shown: object = None
        self._end = 0.0
        self.frame = frame = ttk.Frame(parent)
        self.run = ttk.Button(frame, text="Pause", width=7, command=lambda: toggle(simulation), takefocus=False)
        self.run.pack(side="left")
        tooltip.attach(self.run, "Pause robot time, or go on: F5")
        self.step = ttk.Button(frame, text="Step", width=5, command=simulation.step, takefocus=False)
        self.step.pack(side="left", padx=(px(4), px(14)))
        tooltip.attach(self.step, "Let one packet pass, 0.02 s, and pause: F6")
        ttk.Label(frame, text="Speed", style="Muted.TLabel").pack(side="left")
        self.speed = Slider(frame, theme, px(130), self._speed_moved)
        self.speed.pack(side="left", padx=(px(6), px(4)))
        tooltip.attach(self.speed, "Robot seconds per second, from 0.1 to 8; at the right end: as fast as possible")
        self._speed_text = ttk.Label(frame, width=5)
        self._speed_text.pack(side="left", padx=(0, px(14)))
        self._time = ttk.Label(frame, font=theme.bold, width=8, anchor="e")
        self._time.pack(side="left")
        self.timeline = Slider(frame, theme, px(200), self._time_moved)
        self.timeline.pack(side="left", fill="x", expand=True, padx=px(8))
        tooltip.attach(self.timeline, "Drag it back to a moment, and drive on from there")
        self._length = ttk.Label(frame, style="Muted.TLabel", width=9)
        self._length.pack(side="left")
        self.restart = ttk.Button(frame, text="Restart", command=simulation.restart, takefocus=False)
        self.restart.pack(side="left", padx=(px(8), px(4)))
        tooltip.attach(self.restart, "Start the robot program again, at time 0: F9")
        self.save = ttk.Button(frame, text="Save…", command=self._save, takefocus=False)
        self.save.pack(side="left")
        tooltip.attach(self.save, "Save the recording, for pyfrc replay and for tests")

    def show(self, snapshot: Snapshot | None, status: Status) -> None:
        """Show the moment, and the speed of time."""
        time = 0.0 if snapshot is None else snapshot.time
        self._end = max(status.length, time)
        if not self.timeline.held:
            self.timeline.show(time / self._end if self._end else 0.0)
            self._time_shown(time)
        self._write(self._length, clock(self._end))
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
        if not self.speed.held:
            self.speed.show(slider_of_speed(status.speed))
            self._speed_text.configure(text=speed_text(status.speed))

    def _time_shown(self, time: float) -> None:
        self._write(self._time, clock(time))

    @staticmethod
    def _write(label: ttk.Label, text: str) -> None:
        if text != label.cget("text"):
            label.configure(text=text)

    def give_up_saving(self) -> None:
        """Close the file dialog where Tk draws it itself; other systems have their own."""
        # Tk waits for this variable; an empty name means "Cancel".
        self.frame.tk.call("set", "::tk::Priv(selectFilePath)", "")

    def _speed_moved(self, place: float, let_go: bool) -> None:
        speed = speed_of_slider(place)
        self._speed_text.configure(text=speed_text(speed))
        self._simulation.set_speed(speed)
        if let_go:
            self._shown = None

    def _time_moved(self, place: float, let_go: bool) -> None:
        self._time_shown(place * self._end)
        if let_go:
            rewind(self._simulation, place * self._end)

    def _save(self) -> None:
        name = filedialog.asksaveasfilename(
            parent=self.frame.winfo_toplevel(),  # in its middle
            title="Save the recording",
            initialdir=self._simulation.project.root,
            initialfile="recording.jsonl",
            defaultextension=".jsonl",
            filetypes=[("Input scripts", "*.jsonl"), ("All files", "*")],
        )
        if name:
            try:
                self._simulation.save(Path(name))
                self.note = f"Saved: {name}"
            except (PyfrcError, OSError) as wrong:
                self.note = f"The recording was not saved: {wrong}"
