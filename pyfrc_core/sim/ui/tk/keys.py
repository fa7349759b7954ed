"""The window's keys: passes on which go down and up, without the keyboard's automatic repeat."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from ..models.driver_station_keys import REPEATING, DriverStationKeys
from ..models.keyboard import canonical

#: On X11, a held key repeats as pairs of a release and a press. It counts as released when no press follows within
#: this time. The time is longer than a packet, so that the robot sees the shortest press.
_REPEAT_MS = 25

_CONTROL = 0x4

_TYPED_INTO = ("Entry", "TEntry", "TCombobox", "Listbox")


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
