"""The window's keys: the Driver Station's, those of time, and driving."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk
from typing import TYPE_CHECKING

from ..models.joysticks import Sticks
from ..models.keyboard import Control, KeyDriver, canonical, layout_for
from .time_bar import TimeBar

if TYPE_CHECKING:
    from ...engine.simulation import Simulation

#: A key that is held repeats itself on X11, each time as if it were let go; it is, when nothing follows for so long.
#: And longer than a packet: the robot is to see the shortest press.
_REPEAT_MS = 25

_CONTROL = 0x4

_TYPED_INTO = ("Entry", "TEntry", "TCombobox", "Listbox")


class Keys:
    """Listens to the whole window's keys, except those that are typed into a field."""

    def __init__(self, root: tk.Tk, simulation: Simulation, sticks: Sticks, time_bar: TimeBar) -> None:
        self._root, self._simulation, self._sticks = root, simulation, sticks
        self.driver = KeyDriver(layout_for(simulation.project.sim_config))
        self._axes: dict[Control, float] = {}
        self._buttons: dict[Control, bool] = {}
        self._leaving: dict[str, str] = {}
        self._actions = {
            "return": simulation.disable,
            "kp_enter": simulation.disable,
            "space": simulation.emergency_stop,
            "f5": time_bar.toggle,
            "f6": simulation.step,
            "f9": simulation.restart,
            "f8": self._lose_or_attach,
        }
        root.bind("<KeyPress>", self._press)
        root.bind("<KeyRelease>", self._release)
        root.bind("<FocusOut>", self._lost)

    def _lose_or_attach(self) -> None:
        snapshot = self._simulation.snapshot
        if snapshot is not None:
            self._simulation.attach_driver_station(not snapshot.station_attached)

    def _press(self, event: tk.Event[tk.Misc]) -> None:
        if self._is_typed_into(event.widget):
            return
        key = canonical(event.keysym)
        if (alarm := self._leaving.pop(key, None)) is not None:
            self._root.after_cancel(alarm)
            if key != "f6":  # of the keys that are held, only stepping goes on
                return
        if int(event.state) & _CONTROL:
            if key == "e":
                self._simulation.enable()
            elif key == "q":
                self._root.quit()
            return
        if (act := self._actions.get(key)) is not None:
            act()
            return
        asked = self.driver.asks_to_enable
        self.driver.press(key)
        if self.driver.asks_to_enable and not asked:
            self._simulation.enable()
        self.pass_on()

    def _release(self, event: tk.Event[tk.Misc]) -> None:
        key = canonical(event.keysym)
        if key not in self._leaving:
            self._leaving[key] = self._root.after(_REPEAT_MS, self._let_go, key)

    def _let_go(self, key: str) -> None:
        self._leaving.pop(key, None)
        self.driver.release(key)
        self.pass_on()

    def _lost(self, event: tk.Event[tk.Misc]) -> None:
        try:
            typed_into = self._root.focus_displayof()
        except KeyError:  # the list of a box, which tkinter does not know
            typed_into = None
        if typed_into is None or self._is_typed_into(typed_into):
            self.driver.release_all()
            self.pass_on()

    @staticmethod
    def _is_typed_into(widget: object) -> bool:
        # A widget that tkinter does not know is its name only.
        if isinstance(widget, ttk.Combobox) and "readonly" in widget.state():
            return False
        return not isinstance(widget, tk.Misc) or widget.winfo_class() in _TYPED_INTO

    def forget(self) -> None:
        """Nothing is to come any more."""
        for alarm in self._leaving.values():
            self._root.after_cancel(alarm)
        self._leaving.clear()

    def pass_on(self) -> None:
        """Move and press what the held keys have changed."""
        axes, buttons = self.driver.axes(), self.driver.buttons()
        for control in axes.keys() | self._axes.keys():
            value = axes.get(control, 0.0)
            if value != self._axes.get(control, 0.0):
                self._sticks.move(*control, value)
        for control, pressed in buttons.items():
            if pressed != self._buttons.get(control, False):
                self._sticks.press(*control, pressed)
        self._axes, self._buttons = axes, buttons
