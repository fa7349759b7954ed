"""The choice of the layout of the keys that drive, with help."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from ..models.driver_station_keys import DriverStationKeys
from ..models.keyboard import BUTTON_KEYS_TEXT, LAYOUTS
from . import theme as colors
from .boxes import tame
from .theme import Theme

_OTHERS = f". Shift: gently. {BUTTON_KEYS_TEXT}: buttons of joystick 0"


class DriveView:
    """Chooses the layout of the keys that drive.

    :param done: called when the user has chosen, so that keys drive again
    """

    def __init__(self, parent: tk.Misc, theme: Theme, keys: DriverStationKeys, done: Callable[[], None]) -> None:
        px = theme.px
        self._keys, self._done = keys, done
        self.frame = colors.card(parent, theme)
        inside = ttk.Frame(self.frame, style="Card.TFrame")
        inside.pack(fill="x", padx=px(10), pady=px(8))
        head = ttk.Frame(inside, style="Card.TFrame")
        head.pack(fill="x")
        ttk.Label(head, text="Keys", style="Title.TLabel").pack(side="left", padx=(0, px(10)))
        self.layout = ttk.Combobox(
            head, values=[each.name for each in LAYOUTS], state="readonly", width=16, font=theme.body, takefocus=False
        )
        self.layout.current(LAYOUTS.index(keys.layout))
        self.layout.bind("<<ComboboxSelected>>", lambda event: self._choose())
        tame(self.layout, done)
        self.layout.pack(side="right", fill="x", expand=True)
        self._help = ttk.Label(inside, style="CardMuted.TLabel", wraplength=px(256), text=keys.layout.help + _OTHERS)
        self._help.pack(anchor="w", pady=(px(4), 0))

    def _choose(self) -> None:
        layout = LAYOUTS[self.layout.current()]
        self._keys.layout = layout
        self._help.configure(text=layout.help + _OTHERS)
        self._done()
