"""The driver station, along the top: modes, enabling, and the emergency stop."""

from __future__ import annotations

import math
import tkinter as tk
from tkinter import ttk
from typing import TYPE_CHECKING

from ...engine.snapshot import Snapshot, Status
from ..models.wording import mode_text
from . import theme as colors
from .theme import Theme
from .tooltip import Tooltip

if TYPE_CHECKING:
    from ...engine.commands import ChosenMode
    from ...engine.simulation import Simulation

_MODES: tuple[tuple[str, ChosenMode], ...] = (
    ("Teleoperated", "teleop"),
    ("Autonomous", "autonomous"),
    ("Test", "test"),
)

_COLORS = {"wait": colors.MUTED, "error": colors.RED, "disabled": colors.TEXT, "enabled": colors.GREEN}


class StationBar:
    """Chooses modes and enables the robot."""

    def __init__(self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation) -> None:
        px = theme.px
        self._shown: object = None
        self._simulation = simulation
        self.frame = frame = ttk.Frame(parent)
        self.mode = tk.StringVar(frame, "teleop")
        self.mode_buttons: dict[str, ttk.Radiobutton] = {}
        for text, mode in _MODES:
            self.mode_buttons[mode] = button = ttk.Radiobutton(
                frame,
                text=text,
                value=mode,
                variable=self.mode,
                command=lambda mode=mode: simulation.choose_mode(mode),  # type: ignore[misc]
                style="Segment.Toolbutton",
                # In letters; wide enough for the bold text of the chosen mode.
                width=math.ceil(theme.bold.measure(text) / theme.body.measure("0")),
                takefocus=False,
            )
            button.pack(side="left", padx=(0, px(1)))
        self.enable = ttk.Button(frame, text="Enable", width=8, style="Go.TButton", takefocus=False)
        self.enable.configure(command=simulation.enable)
        self.enable.pack(side="left", padx=(px(14), px(4)))
        tooltip.attach(self.enable, "Enable the robot: the keys [ ] \\ together, or Ctrl+E")
        self.disable = ttk.Button(frame, text="Disable", width=8, style="Stop.TButton", takefocus=False)
        self.disable.configure(command=simulation.disable)
        self.disable.pack(side="left")
        tooltip.attach(self.disable, "Disable the robot: Enter")
        self.practice = ttk.Button(frame, text="Practice match", command=simulation.practice, takefocus=False)
        self.practice.pack(side="left", padx=(px(14), 0))
        tooltip.attach(self.practice, "Autonomous, a pause and teleop, as long as in a match")
        self.lamp = tk.Canvas(
            frame, width=px(14), height=px(14), background=colors.BACKGROUND, highlightthickness=0, takefocus=False
        )
        self._light = self.lamp.create_oval(px(1), px(1), px(12), px(12), outline="", fill=colors.FAINT)
        self.lamp.pack(side="left", padx=(px(14), px(6)))
        self.state = ttk.Label(frame, font=theme.large)
        self.state.pack(side="left")
        self.stop = ttk.Button(
            frame, text="E-STOP", width=8, style="Stop.TButton", command=simulation.emergency_stop, takefocus=False
        )
        self.stop.pack(side="right", before=self.mode_buttons["teleop"], padx=(px(8), 0))  # always visible
        tooltip.attach(self.stop, "Emergency stop: the space bar. Only a restart enables the robot again.")

    def show(self, snapshot: Snapshot | None, status: Status) -> None:
        """Show the robot's state."""
        text, kind = mode_text(snapshot, status)
        enabled = snapshot is not None and snapshot.enabled
        mode = "teleop" if snapshot is None else snapshot.chosen_mode
        state = text, kind, enabled, mode
        if state == self._shown:
            return
        self._shown = state
        self.mode.set(mode)
        self.state.configure(text=text, foreground=_COLORS[kind])
        light = {"enabled": colors.LAMP_ON, "error": colors.RED}.get(kind, colors.FAINT)
        self.lamp.itemconfigure(self._light, fill=light)
        ready = kind in ("disabled", "enabled")
        self.enable.state(["!disabled" if ready and not enabled else "disabled"])
        self.disable.state(["!disabled" if ready and enabled else "disabled"])
        self.practice.state(["!disabled" if ready else "disabled"])
        self.stop.state(["!disabled" if ready else "disabled"])
