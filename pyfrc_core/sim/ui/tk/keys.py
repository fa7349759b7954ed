"""The window's keys: which go down and up, without the keyboard's automatic repeat, and the choice of their layout."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from tkinter import ttk

from ..models.driver_station_keys import REPEATING, DriverStationKeys
from ..models.keyboard import BUTTON_KEYS_TEXT, LAYOUTS, canonical
from . import theme as colors
from .boxes import tame
from .theme import Theme

#: On X11, a held key repeats as pairs of a release and a press. It counts as released when no press follows within
#: this time. The time is longer than a packet, so that the robot sees the shortest press.
_REPEAT_MS = 25

_CONTROL = 0x4

_TYPED_INTO = ("Entry", "TEntry", "TCombobox", "Listbox")
_OTHERS = f". Shift: gently. {BUTTON_KEYS_TEXT}: buttons of joystick 0"


class Keys:
    """Listens to the whole window's keys, except those that are typed into a field.

    :param keys: acts on them
    """

    def __init__(self, root: tk.Tk, keys: DriverStationKeys) -> None:
        self._root, self._keys = root, keys
        #: The timers of keys that have gone up, and perhaps only repeat.
        self._released: dict[str, str] = {}
        root.bind("<KeyPress>", self._on_press)
        root.bind("<KeyRelease>", self._on_release)
        root.bind("<FocusOut>", self._on_focus_lost)

    def close(self) -> None:
        """Cancel what is still to come."""
        for timer in self._released.values():
            self._root.after_cancel(timer)
        self._released.clear()

    def _on_press(self, event: tk.Event[tk.Misc]) -> None:
        if self._is_typed_into(event.widget):
            return
        key = canonical(event.keysym)
        if (timer := self._released.pop(key, None)) is not None:
            self._root.after_cancel(timer)
            if key not in REPEATING:
                return
        self._keys.press(key, control=bool(int(event.state) & _CONTROL))

    def _on_release(self, event: tk.Event[tk.Misc]) -> None:
        key = canonical(event.keysym)
        if key not in self._released:
            self._released[key] = self._root.after(_REPEAT_MS, self._release, key)

    def _release(self, key: str) -> None:
        self._released.pop(key, None)
        self._keys.release(key)

    def _on_focus_lost(self, event: tk.Event[tk.Misc]) -> None:
        try:
            typed_into = self._root.focus_displayof()
        except KeyError:  # a combobox's list, which tkinter does not know
            typed_into = None
        if typed_into is None or self._is_typed_into(typed_into):
            self._keys.release_all()

    @staticmethod
    def _is_typed_into(widget: object) -> bool:
        # A widget that tkinter does not know is a string, its name.
        if isinstance(widget, ttk.Combobox) and "readonly" in widget.state():
            return False
        return not isinstance(widget, tk.Misc) or widget.winfo_class() in _TYPED_INTO


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
