"""The choices before a match: alliance, game data, start position, choosers such as the autonomous mode."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from ...engine.simulation import Simulation
from ...engine.snapshot import Chooser, Snapshot
from ..models.wording import STATIONS, station_name
from . import theme as colors
from .boxes import has_keys, tame
from .theme import Theme, fitting
from .tooltip import Tooltip

#: The greatest width of the labels before the boxes, in pixels of the design.
_LABEL = 96


class MatchView:
    """Choices, each a box with a list.

    :param done: called when the user has chosen, so that keys drive again
    """

    def __init__(
        self, parent: tk.Misc, theme: Theme, tooltip: Tooltip, simulation: Simulation, done: Callable[[], None]
    ) -> None:
        self._theme, self._tooltip, self._simulation, self._done = theme, tooltip, simulation, done
        px = theme.px
        self.frame = colors.card(parent, theme)
        self._grid = grid = ttk.Frame(self.frame, style="Card.TFrame")
        grid.pack(fill="x", padx=px(10), pady=px(8))
        grid.columnconfigure(1, weight=1)
        self._rows = 0
        self._shown: tuple[object, ...] = ()
        #: The game data that the robot has.
        self._sent = ""
        self._alliance = self._box(list(STATIONS), self._choose_alliance)
        self._message = self._box(list(simulation.project.game_specific_messages), self._send_message, "normal")
        self._message.bind("<Return>", lambda event: self._send_message())
        self._message.bind("<FocusOut>", lambda event: self._send_typed_message())
        tooltip.attach(self._message, "Game data, which the field sends to all robots: choose, or type and press Enter")
        self._place_row("Alliance", self._alliance)
        self._place_row("Game data", self._message)
        starts = list(simulation.field.starts)
        self._start = self._box(starts, self._reset)
        if starts:
            self._start.current(0)
        self.reset = ttk.Button(grid, text="Reset", width=6, style="Tiny.TButton", command=self._reset, takefocus=False)
        tooltip.attach(self.reset, "Put the robot back to its start. It can also be dragged on the field.")
        self._place_row("Start", self._start, self.reset)
        self._choosers: dict[str, tuple[Chooser, ttk.Label, ttk.Combobox]] = {}

    def show(self, snapshot: Snapshot) -> None:
        """Show the current choices."""
        values = snapshot.values
        chosen = values.get("alliance_station"), values.get("event.game_specific_message"), snapshot.choosers
        if chosen == self._shown:
            return
        self._shown = chosen
        self._alliance.set(station_name(chosen[0]))
        self._sent = str(chosen[1] or "")
        if not has_keys(self._message):
            self._message.set(self._sent)
        self._show_choosers(snapshot.choosers)

    def _show_choosers(self, choosers: tuple[Chooser, ...]) -> None:
        named = {each.name: each for each in choosers}
        for name in self._choosers.keys() - named.keys():
            _, label, box = self._choosers.pop(name)
            label.destroy()
            box.destroy()
        for name, chooser in named.items():
            if name not in self._choosers:
                box = self._box([], lambda name=name: self._choose(name))  # type: ignore[misc]
                # The list may be wider than the box, towards the left.
                box.configure(style="Wide.TCombobox")
                label = self._place_row(name.rpartition("/")[2], box)
                self._tooltip.attach(label, name)
                box.bind("<Enter>", lambda event, box=box: self._tooltip.expect(box.get(), event.x_root, event.y_root))  # type: ignore[misc]
                box.bind("<Leave>", lambda event: self._tooltip.hide())
                box.bind("<Button>", lambda event: self._tooltip.hide(), add="+")
            else:
                _, label, box = self._choosers[name]
            self._choosers[name] = chooser, label, box
            box.configure(values=chooser.options)
            box.set(chooser.active or chooser.default)

    def _box(self, values: list[str], chosen: Callable[[], None], state: str = "readonly") -> ttk.Combobox:
        box = ttk.Combobox(self._grid, values=values, state=state, width=10, font=self._theme.body, takefocus=False)
        box.bind("<<ComboboxSelected>>", lambda event: chosen())
        if state == "readonly":
            tame(box, self._done)
        return box

    def _place_row(self, text: str, box: ttk.Combobox, beside: ttk.Widget | None = None) -> ttk.Label:
        px = self._theme.px
        label = ttk.Label(self._grid, text=fitting(text, self._theme.body, px(_LABEL)), style="Card.TLabel")
        label.grid(row=self._rows, column=0, sticky="w", padx=(0, px(10)), pady=px(2))
        box.grid(row=self._rows, column=1, columnspan=1 if beside else 2, sticky="ew", pady=px(2))
        if beside is not None:
            beside.grid(row=self._rows, column=2, sticky="ew", padx=(px(4), 0), pady=px(2))
        self._rows += 1
        return label

    def _choose_alliance(self) -> None:
        self._simulation.set_alliance(STATIONS[self._alliance.get()])
        self._done()

    def _send_message(self) -> None:
        self._send_typed_message()
        self._done()

    def _send_typed_message(self) -> None:
        if self._message.get() != self._sent:
            self._sent = self._message.get()
            self._simulation.set_game_message(self._sent)

    def _reset(self) -> None:
        self._simulation.reset_position(self._start.get() or None)
        self._done()

    def _choose(self, name: str) -> None:
        self._simulation.choose(name, self._choosers[name][2].get())
        self._done()
