"""The driver station, along the top: modes, enabling, and the emergency stop."""

from __future__ import annotations

import math
import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from ...engine.commands import ChosenMode
from ...engine.simulation import Simulation
from ...engine.snapshot import Opmode, Snapshot, Status
from ..models.wording import MODES, NO_OPMODE, mode_text
from . import theme as colors
from .boxes import tame
from .theme import Theme
from .tooltip import Tooltip

_COLORS = {"wait": colors.MUTED, "error": colors.RED, "disabled": colors.TEXT, "enabled": colors.GREEN}


class StationBar:
    """Chooses modes and enables the robot.

    :param done: called when the user has chosen an opmode, so that keys drive again
    """

    def __init__(
        self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation, done: Callable[[], None]
    ) -> None:
        px = theme.px
        self._shown: object = None
        self._simulation = simulation
        self.frame = frame = ttk.Frame(parent)
        self.mode = tk.StringVar(frame, "teleop")
        self.mode_buttons: dict[str, ttk.Radiobutton] = {}
        for mode, text in MODES.items():
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
        self._mode: ChosenMode = "teleop"
        self._done, self._gap = done, px(8)
        #: Shown when the robot has opmodes.
        self.opmode = ttk.Combobox(frame, state="readonly", width=14, font=theme.body, takefocus=False)
        self.opmode.bind("<<ComboboxSelected>>", lambda event: self._choose_opmode())
        tame(self.opmode, done)
        tooltip.attach(self.opmode, "The opmode that runs in this mode. Choosing another one disables the robot.")
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
        mode: ChosenMode = "teleop" if snapshot is None else snapshot.chosen_mode
        opmodes, opmode = ((), "") if snapshot is None else (snapshot.opmodes, snapshot.opmode)
        state = text, kind, enabled, mode, opmodes, opmode
        if state == self._shown:
            return
        self._shown = state
        self.mode.set(mode)
        self._mode = mode
        self._show_opmodes(opmodes, opmode)
        self.state.configure(text=text, foreground=_COLORS[kind])
        light = {"enabled": colors.LAMP_ON, "error": colors.RED}.get(kind, colors.FAINT)
        self.lamp.itemconfigure(self._light, fill=light)
        ready = kind in ("disabled", "enabled")
        self.enable.state(["!disabled" if ready and not enabled else "disabled"])
        self.disable.state(["!disabled" if ready and enabled else "disabled"])
        self.practice.state(["!disabled" if ready else "disabled"])
        self.stop.state(["!disabled" if ready else "disabled"])

    def _show_opmodes(self, opmodes: tuple[Opmode, ...], chosen: str) -> None:
        if not opmodes:
            self.opmode.pack_forget()
            return
        self.opmode.pack(side="left", padx=(self._gap, 0), after=self.mode_buttons["test"])
        self.opmode.configure(values=[NO_OPMODE, *(each.name for each in opmodes if each.mode == self._mode)])
        self.opmode.set(chosen or NO_OPMODE)

    def _choose_opmode(self) -> None:
        index = self.opmode.current()
        self._simulation.choose_opmode(self.opmode.get() if index > 0 else "", self._mode)
        self._done()
